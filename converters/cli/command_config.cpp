// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/command_config.h"

#include <algorithm>
#include <optional>
#include <set>

#include "converters/base/error.h"
#include "converters/base/suggestion.h"
#include "converters/base/text.h"
#include "converters/cli/command_line.h"

namespace lumen::app {

namespace {

struct ConfigLine {
  std::string place;    ///< "FILE: line 3: "
  std::string section;  ///< empty: for every command
  std::string key;
  std::vector<std::string> values;
};

[[noreturn]] void refuse(const std::string& place, const std::string& text) {
  throw Error(ErrorKind::Usage, place + text);
}

/// Without what follows a "#" outside of quotes, and without white space at the ends.
std::string withoutComment(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '#')
      return trimmed(line.substr(0, i));
  }
  return trimmed(line);
}

/// The parts between commas that are outside of quotes.
std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts(1);
  char quote = 0;
  for (const char c : text) {
    if (c == ',' && quote == 0) {
      parts.emplace_back();
      continue;
    }
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    parts.back() += c;
  }
  return parts;
}

std::string unquoted(const std::string& place, const std::string& text) {
  const std::string word = trimmed(text);
  if (word.empty() || (word[0] != '"' && word[0] != '\'')) return word;
  if (word.size() < 2 || word.find(word[0], 1) != word.size() - 1)
    refuse(place, "found " + word + ", expected a text that begins and ends with a quote");
  return word.substr(1, word.size() - 2);
}

std::vector<std::string> valuesOf(const std::string& place, const std::string& text) {
  const bool isList = text.starts_with('[');
  if (isList && !text.ends_with(']')) refuse(place, "found " + text + ", expected a ] at the end");
  std::vector<std::string> values;
  for (const auto& part : splitAtCommas(isList ? text.substr(1, text.size() - 2) : text))
    values.push_back(unquoted(place, part));
  return values;
}

std::vector<ConfigLine> parseLines(std::istream& input, const std::string& file) {
  std::vector<ConfigLine> lines;
  std::string section, text;
  for (int number = 1; std::getline(input, text); ++number) {
    const std::string place = file + ": line " + std::to_string(number) + ": ";
    const std::string line = withoutComment(text);
    if (line.empty()) continue;
    if (line.front() == '[') {
      if (line.back() != ']') refuse(place, "found " + line + ", expected a ] at the end");
      section = trimmed(line.substr(1, line.size() - 2));
      lines.push_back({place, section, "", {}});
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
      refuse(place, "found " + line + ", expected a line such as \"threads = 4\"");
    lines.push_back({place, section, unquoted(place, line.substr(0, equals)),
                     valuesOf(place, trimmed(line.substr(equals + 1)))});
  }
  return lines;
}

/// The option that a line of a file may set; null if there is none.
const CLI::Option* configurable(const CLI::App& app, const std::string& key) {
  const CLI::Option* option = app.get_option_no_throw("--" + key);
  return option != nullptr && option->get_configurable() ? option : nullptr;
}

std::vector<std::string> keysOf(const CLI::App& app) {
  std::vector<std::string> keys;
  for (const CLI::Option* option : app.get_options())
    if (option->get_configurable())
      for (const auto& name : option->get_lnames()) keys.push_back(name);
  return keys;
}

void checkLine(const ConfigLine& line, const CLI::App& app, const std::string& command) {
  const CLI::Option* option = configurable(app, line.key);
  if (option == nullptr)
    refuse(line.place, line.key + ": lumen " + command + " has no such option" +
                           didYouMean(line.key, keysOf(app)));
  if (option->get_expected_min() > 0) return;
  static const std::set<std::string> kSwitch = {"true", "false", "yes", "no",
                                                "on",   "off",   "1",   "0"};
  const std::string& value = line.values.front();
  if (line.values.size() != 1 || !kSwitch.contains(lowerCase(value)))
    refuse(line.place, line.key + ": found " + (value.empty() ? "nothing" : value) +
                           ", expected true or false");
}

/// Sections of other commands do not matter to this one, but a misspelt one would never matter.
void checkOtherLine(const ConfigLine& line) {
  std::vector<std::string> names;
  for (const auto& command : allCommands()) {
    names.push_back(command->name());
    if (command->name() != line.section) continue;
    if (line.key.empty()) return;
    CLI::App app;
    CommonOptions common;
    bindOptions(app, *command, common);
    return checkLine(line, app, line.section);
  }
  refuse(line.place,
         "[" + line.section + "] is not a command of lumen" + didYouMean(line.section, names));
}

}  // namespace

std::vector<CLI::ConfigItem> CommandConfig::from_config(std::istream& input) const {
  const auto file = m_app.get_config_ptr()->as<std::string>();
  std::vector<CLI::ConfigItem> own, common;
  std::map<std::string, std::string> seen;
  for (const ConfigLine& line : parseLines(input, file)) {
    const bool isOwn = line.section.empty() || line.section == m_command;
    if (!isOwn) checkOtherLine(line);
    if (line.key.empty()) continue;
    const auto [first, isNew] = seen.emplace(line.section + "/" + line.key, line.place);
    if (!isNew)
      refuse(line.place,
             line.key + " is set twice; see " + first->second.substr(0, first->second.size() - 2));
    if (!isOwn) continue;
    checkLine(line, m_app, m_command);
    // what the command line gives wins
    if (const std::string name = "--" + line.key; m_app.get_option(name)->count() == 0) {
      if (!line.section.empty()) m_places[name] = line.place;
      m_places.emplace(name, line.place);
    }
    CLI::ConfigItem item;
    item.name = line.key;
    item.inputs = line.values;
    (line.section.empty() ? common : own).push_back(std::move(item));
  }
  // the parser keeps the first value that it meets
  own.insert(own.end(), common.begin(), common.end());
  return own;
}

std::string CommandConfig::placeOf(const std::string& option) const {
  const auto place = m_places.find(option);
  return place == m_places.end() ? "" : place->second;
}

}  // namespace lumen::app
