// SPDX-License-Identifier: Apache-2.0
// The end of an answer about a file: what lumen makes of it, and the command that does.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "converters/engine/command.h"

namespace lumen::engine {

struct NextStep {
  std::vector<std::string> assumed;  ///< sentences on what the file leaves open
  std::string does;                  ///< "lumen finds its vessels"
  std::string command;               ///< as people type it
};

/// "lumen convert FILE STEM.lumen", with the options of `table` that were given and that both commands
/// have. `stem`: of the output, in the folder where the command is typed.
std::string convertCommand(const OptionTable& table, const std::string& file,
                           const std::string& stem);

/// Adds the step to an answer whose text has this column.
Answer withNext(Answer answer, const NextStep& next, std::size_t column);

}  // namespace lumen::engine
