// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/command_config.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/text.h"

namespace lumen::cli {

namespace {

[[noreturn]] void refuse(const std::string& place, const std::string& text) {
  throw Error(ErrorKind::Usage, place + text);
}

/// A quote opens a text only where a text can begin: at the start, and after "=", "," or "[". An
/// apostrophe within a word is a letter.
bool opensText(const std::string& line, std::size_t at) {
  if (line[at] != '"' && line[at] != '\'') return false;
  const std::size_t before = at == 0 ? std::string::npos : line.find_last_not_of(" \t", at - 1);
  return before == std::string::npos || std::string("=,[").find(line[before]) != std::string::npos;
}

/// The line up to a "#" outside of quotes, trimmed.
std::string withoutComment(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (opensText(line, i))
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
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == ',' && quote == 0) {
      parts.emplace_back();
      continue;
    }
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (opensText(text, i))
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

std::vector<std::string> parseValues(const std::string& place, const std::string& text) {
  const bool isList = text.starts_with('[');
  if (isList && !text.ends_with(']')) refuse(place, "found " + text + ", expected a ] at the end");
  std::vector<std::string> values;
  for (const auto& part : splitAtCommas(isList ? text.substr(1, text.size() - 2) : text))
    values.push_back(unquoted(place, part));
  return values;
}

}  // namespace

struct CommandConfig::Line {
  std::string place;    ///< "FILE: line 3: "
  std::string section;  ///< empty: for every command
  std::string key;
  std::vector<std::string> values;
};

std::vector<CommandConfig::Line> CommandConfig::linesIn(std::istream& input,
                                                        const std::string& file) {
  std::vector<Line> lines;
  std::string section, text;
  for (int number = 1; std::getline(input, text); ++number) {
    const std::string place = file + ": line " + std::to_string(number) + ": ";
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (number == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
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
                     parseValues(place, trimmed(line.substr(equals + 1)))});
  }
  return lines;
}

void CommandConfig::checkLine(const Line& line, const engine::BoundCommand& command) const {
  const OptionRow* row = command.table->find(line.key);
  if (row == nullptr) row = m_common.find(line.key);
  if (row == nullptr) {
    std::vector<std::string> keys;
    for (const OptionTable* table : {command.table.get(), const_cast<OptionTable*>(&m_common)})
      for (const OptionRow& one : table->rows())
        if (!one.isArgument) keys.push_back(one.name);
    refuse(line.place, line.key + ": lumen " + command.command->name() + " has no such option" +
                           didYouMean(line.key, keys));
  }
  if (!row->isFlag()) return;
  static const std::set<std::string> kSwitch = {"true", "false", "yes", "no",
                                                "on",   "off",   "1",   "0"};
  const std::string& value = line.values.front();
  if (line.values.size() != 1 || !kSwitch.contains(lowerCase(value)))
    refuse(line.place, line.key + ": found " + (value.empty() ? "nothing" : value) +
                           ", expected true or false");
}

/// Checks a line for another command: its values do not matter here, but its names must exist, as a
/// misspelt section would be ignored by every command.
void CommandConfig::checkOtherLine(const Line& line) const {
  if (const engine::BoundCommand other = m_commands.find(line.section); other.command) {
    if (!line.key.empty()) checkLine(line, other);
    return;
  }
  std::vector<std::string> names;
  for (const auto& [command, table] : m_commands.commands()) names.push_back(command->name());
  refuse(line.place,
         "[" + line.section + "] is not a command of lumen" + didYouMean(line.section, names));
}

std::vector<CLI::ConfigItem> CommandConfig::from_config(std::istream& input) const {
  const auto file = m_app.get_config_ptr()->as<std::string>();
  std::vector<CLI::ConfigItem> own, common;
  std::map<std::string, std::string> seen;
  for (const Line& line : linesIn(input, file)) {
    const bool isOwn = line.section.empty() || line.section == m_command.command->name();
    if (!isOwn) checkOtherLine(line);
    if (line.key.empty()) continue;
    const auto [first, isNew] = seen.emplace(line.section + "/" + line.key, line.place);
    if (!isNew)
      refuse(line.place,
             line.key + " is set twice; see " + first->second.substr(0, first->second.size() - 2));
    if (!isOwn) continue;
    checkLine(line, m_command);
    // options of the command line win
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

}  // namespace lumen::cli
