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

namespace lumen::app {

/// Of one command, whose parser it must not outlive. All that is wrong in the file throws
/// Error(Usage) with the file's name and the line.
class CommandConfig : public CLI::Config {
public:
  CommandConfig(const CLI::App& app, std::string command)
      : m_app(app), m_command(std::move(command)) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;
  std::string to_config(const CLI::App*, bool, bool, std::string) const override { return {}; }

  /// "FILE: line 3: " if this option ("--cell") has its value from the file, otherwise nothing.
  [[nodiscard]] std::string placeOf(const std::string& option) const;

private:
  const CLI::App& m_app;
  std::string m_command;
  mutable std::map<std::string, std::string> m_places;  ///< by the option's name with its dashes
};

}  // namespace lumen::app
