// SPDX-License-Identifier: Apache-2.0
// What is said of arguments that make no sense.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "converters/base/error.h"
#include "converters/cli/command_config.h"

namespace lumen::app {

/// The complaint for what the parser refused: what is wrong, in which line of which file if it came
/// from one, and what was probably meant.
Error usageError(const CLI::App& app, const CLI::ParseError& error, const std::string& command,
                 const CommandConfig& config);

/// "; did you mean lumen convert?" or where the word would make sense, for a first word that is not a
/// command.
Error unknownCommand(const std::string& word);

}  // namespace lumen::app
