// SPDX-License-Identifier: Apache-2.0
// Scripts by which shells complete commands, options, words of options and topics of the manual, made of
// one list of them.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/command.h"

namespace lumen::cli {

struct CompletedOption {
  std::string name;                 ///< "--inlier-rate"
  std::string help;                 ///< one line
  bool takesValue = false;          ///< it is no flag
  std::vector<std::string> values;  ///< the words that it takes; empty: any text, or a file
};

struct CompletedCommand {
  std::string name;     ///< one word, or a group's word and another: "library add"
  std::string summary;  ///< one line
  std::vector<CompletedOption> options;
};

struct Completion {
  std::vector<CompletedCommand> commands;  ///< in the order of the help
  std::vector<CompletedCommand> groups;    ///< words before others, such as "library"
  std::vector<CompletedCommand> topics;    ///< of the manual, which `lumen help` takes
};

/// All commands with their rows, and the options that every command has.
Completion completionOf(const engine::Engine& commands);

/// Each answers with names of files wherever the list has nothing.
std::string bashScript(const Completion& completion);
std::string zshScript(const Completion& completion);
std::string fishScript(const Completion& completion);

}  // namespace lumen::cli
