// SPDX-License-Identifier: Apache-2.0
// What a subcommand of `lumen` is.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/cli/interrupt.h"
#include "converters/cli/terminal_progress.h"

namespace lumen::app {

/// The options that every command has.
struct CommonOptions {
  int threads = 0;  ///< 0: all cores
  bool quiet = false;
  bool verbose = false;
  bool strict = false;  ///< a warning is an error: Progress::warn() throws
  bool json = false;    ///< the answer on standard output is one JSON object
};

/// What a running command may use besides its own options.
struct Context {
  const CommonOptions& common;
  Progress& progress;
  InterruptGuard& interrupts;
};

class Command {
public:
  Command() = default;
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// One word, or a group's word and another: "library add".
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string summary() const = 0;  ///< one line
  [[nodiscard]] virtual std::string example() const = 0;  ///< shell lines for the help's end
  /// Adds the command's own options to its parser.
  virtual void bind(CLI::App& app) = 0;
  /// Does the work; answers on standard output. Throws lumen::Error; returns the exit code.
  virtual int run(Context& context) = 0;
};

/// Every command of lumen, in the order of the help: the list in commands.cpp.
std::vector<std::unique_ptr<Command>> allCommands();

/// What the commands do whose names begin with this word and a space, in one line; null for another word.
const char* groupSummary(const std::string& word);

/// The first word of a command's name.
inline std::string firstWord(const std::string& name) {
  return name.substr(0, name.find(' '));
}

}  // namespace lumen::app
