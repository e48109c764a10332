// SPDX-License-Identifier: Apache-2.0
#include "contact_options.h"

#include <filesystem>
#include <stdexcept>

namespace lumen::bench {

ContactOptions contactOptions(int argc, char** argv, ContactOptions options) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc)
      options.json = argv[++i];
    else if (argument == "--environments" && i + 1 < argc)
      options.environments = std::stoul(argv[++i]);
    else if (argument == "--turns" && i + 1 < argc)
      options.turns = std::stoi(argv[++i]);
    else
      options.cases.push_back(argument);
  }
  if (options.cases.empty() || options.json.empty() || options.environments == 0)
    throw std::runtime_error("usage: " + std::filesystem::path(argv[0]).filename().string() +
                             " --json FILE [--environments N] [--turns N] CASE...");
  return options;
}

}  // namespace lumen::bench
