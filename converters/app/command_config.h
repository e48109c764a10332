// SPDX-License-Identifier: Apache-2.0
// The file of --config: a line "name = value" for each option, without its dashes; "#" starts a
// comment. Lines before any section hold for every command; those under [convert], [track], ... for
// that one only, and they win over the former.
#pragma once

#include <algorithm>
#include <istream>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lumen::app {

class CommandConfig : public CLI::ConfigTOML {
public:
  CommandConfig(std::string command, std::vector<std::string> allCommands)
      : m_command(std::move(command)), m_allCommands(std::move(allCommands)) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> own, common;
    std::istringstream plain(withoutSectionComments(input));
    for (CLI::ConfigItem& item : CLI::ConfigTOML::from_config(plain)) {
      if (item.name == "++" || item.name == "--")
        continue;  // marks where a section begins and ends
      if (item.parents.empty()) {
        common.push_back(std::move(item));
      } else if (item.parents.size() == 1 && item.parents[0] == m_command) {
        item.parents.clear();
        own.push_back(std::move(item));
      } else if (item.parents.size() != 1 || !isCommand(item.parents[0])) {
        throw CLI::ConfigError("the section of " + item.fullname() + " is not a command of lumen",
                               CLI::ExitCodes::ConfigError);
      }
    }
    // the parser keeps the first value that it meets
    own.insert(own.end(), common.begin(), common.end());
    return own;
  }

private:
  /// The base class takes a line for a section's only if nothing follows the bracket.
  static std::string withoutSectionComments(std::istream& input) {
    std::string text;
    for (std::string line; std::getline(input, line);) {
      const bool isSection = CLI::detail::trim_copy(line).starts_with('[');
      text += (isSection ? line.substr(0, line.find('#')) : line) + "\n";
    }
    return text;
  }

  [[nodiscard]] bool isCommand(const std::string& name) const {
    return std::find(m_allCommands.begin(), m_allCommands.end(), name) != m_allCommands.end();
  }

  std::string m_command;
  std::vector<std::string> m_allCommands;
};

}  // namespace lumen::app
