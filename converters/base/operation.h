// SPDX-License-Identifier: Apache-2.0
// What somebody asks the program for, as plain texts: the same for the command line, the viewer, lists of cases and
// processes that are started for one of them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace lumen {

struct Operation {
  std::string name;                    ///< of a command: "convert", "library add"
  std::vector<std::string> arguments;  ///< in their order
  /// Names without dashes, with their values; "true" or "false" for a flag.
  std::vector<std::pair<std::string, std::vector<std::string>>> options;

  Operation& with(std::string option, std::string value) {
    options.push_back({std::move(option), {std::move(value)}});
    return *this;
  }
};

/// The end of an operation that a process of its own did.
struct OperationEnd {
  bool isDone = false;
  int code = 0;       ///< exit code
  std::string error;  ///< one sentence, if it is not done
  std::size_t warnings = 0;
};

}  // namespace lumen
