// SPDX-License-Identifier: Apache-2.0
// All commands of the program, and the options that each has.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "converters/engine/command.h"

namespace lumen::cli {

/// The commands of the engine, `lumen view` and `lumen completion`.
engine::Engine allCommands();

/// Lets the commands that run make pages of the viewer, if the program was built with it.
void addViewerPage(engine::RunSettings& settings);

/// Summary, in one line, of the commands whose names begin with this word and a space; null for
/// another word.
const char* groupSummary(const std::string& word);

/// The options that every command has.
struct CommonOptions {
  int threads = 0;  ///< 0: all cores
  bool quiet = false;
  bool verbose = false;
  bool strict = false;  ///< a warning is an error: Progress::warn() throws
  bool json = false;    ///< the answer on standard output is one JSON object

  /// Adds their rows, whose values are stored in this object.
  void addRows(OptionTable& table);
};

/// The row of --config, which the parser itself reads.
OptionRow configRow();

// lumen completion: the words that a shell offers when the tabulator key is pressed.

std::unique_ptr<engine::Command> makeCompletionCommand();

}  // namespace lumen::cli
