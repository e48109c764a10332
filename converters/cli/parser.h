// SPDX-License-Identifier: Apache-2.0
// Parser of command lines, made from rows of options. CLI11 takes the words apart; the rows judge
// and store the values.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/base/options/option_table.h"
#include "converters/cli/command_config.h"
#include "converters/engine/command.h"

namespace lumen::cli {

/// The parser of one command. The commands, the command and the table must outlive it.
class CommandParser {
public:
  /// `common` has the rows that every command has.
  CommandParser(const engine::Engine& commands, const engine::BoundCommand& command,
                OptionTable& common);

  /// Parses the words and sets the rows. Throws Error(Usage), Error(InvalidInput) for a
  /// configuration file that is not there, and CLI::CallForHelp.
  void parse(int argc, const char* const* argv);
  /// The help, which ends with `footer`.
  [[nodiscard]] std::string help(const std::string& footer);

private:
  void add(OptionTable& table);
  CLI::Option* addRow(const OptionRow& row);
  CLI::Option* findOption(const OptionRow& row) const;

  const engine::Engine& m_commands;
  const engine::BoundCommand& m_command;
  CLI::App m_app;
  std::shared_ptr<CommandConfig> m_config;
  std::vector<std::pair<OptionRow*, CLI::Option*>> m_options;
};

}  // namespace lumen::cli
