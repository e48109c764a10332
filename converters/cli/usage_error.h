// SPDX-License-Identifier: Apache-2.0
// Messages about arguments that make no sense.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "converters/base/error.h"
#include "converters/cli/command_config.h"

namespace lumen::cli {

/// Error for an argument that the parser refused, with the line of the configuration file if the
/// argument came from one, and a suggestion.
Error usageError(const CLI::App& app, const CLI::ParseError& error, const engine::Engine& commands,
                 const engine::BoundCommand& command, const CommandConfig& config);

/// The error for a first word that is not a command, with a suggestion.
Error unknownCommand(const std::string& word, const engine::Engine& commands);

}  // namespace lumen::cli
