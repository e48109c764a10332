// SPDX-License-Identifier: Apache-2.0
// A request to the program as plain texts, equal for the command line, the viewer, lists of cases
// and the processes that they start.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace lumen {

struct Operation {
  std::string name;                    ///< command: "convert", "library add"
  std::vector<std::string> arguments;  ///< in their order
  /// Names without dashes, with their values; "true" or "false" for a flag.
  std::vector<std::pair<std::string, std::vector<std::string>>> options;

  Operation& with(std::string option, std::string value) {
    options.push_back({std::move(option), {std::move(value)}});
    return *this;
  }
};

/// Result of an operation in a process of its own.
struct OperationEnd {
  bool isDone = false;
  int code = 0;        ///< exit code
  std::string error;   ///< one sentence, if it is not done
  std::string answer;  ///< JSON, as --json prints it; empty if there is none
  std::size_t warnings = 0;
};

}  // namespace lumen
