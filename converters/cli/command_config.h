// SPDX-License-Identifier: Apache-2.0
// The file of --config: a line "name = value" for each option, without its dashes; "#" starts a
// comment. Lines before any section hold for every command; those under [convert], [track], ... for
// that one only, and they win over the former. A value is a word, a number, true or false, a text
// in quotes, or a list in brackets.
#pragma once

#include <istream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/base/options/option_table.h"
#include "converters/engine/command.h"

namespace lumen::cli {

/// Reads the file for one command, whose parser it must not outlive. Throws Error(Usage) with the
/// file's name and the line for everything that is wrong in it.
class CommandConfig : public CLI::Config {
public:
  CommandConfig(const CLI::App& app, const engine::Engine& commands,
                const engine::BoundCommand& command, const OptionTable& common)
      : m_app(app), m_commands(commands), m_command(command), m_common(common) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;
  std::string to_config(const CLI::App*, bool, bool, std::string) const override { return {}; }

  /// "FILE: line 3: " if this option ("--cell") has its value from the file, otherwise nothing.
  [[nodiscard]] std::string placeOf(const std::string& option) const;

private:
  struct Line;
  static std::vector<Line> linesIn(std::istream& input, const std::string& file);
  void checkLine(const Line& line, const engine::BoundCommand& command) const;
  void checkOtherLine(const Line& line) const;

  const CLI::App& m_app;
  const engine::Engine& m_commands;
  const engine::BoundCommand& m_command;
  const OptionTable& m_common;
  mutable std::map<std::string, std::string> m_places;  ///< keys: the option's name with its dashes
};

}  // namespace lumen::cli
