// SPDX-License-Identifier: Apache-2.0
// From argv to a running command and its exit code.
#pragma once

#include "converters/cli/command.h"

namespace lumen::app {

/// Adds the options of one command, and those that all have, to its parser. Both are filled when
/// the parser runs, and must outlive it.
void bindOptions(CLI::App& app, Command& command, CommonOptions& common);

/// Parses, runs, and translates everything that is thrown into one line on standard error and an
/// exit code.
int runCommandLine(int argc, const char* const* argv);

}  // namespace lumen::app
