// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/usage_error.h"

#include <filesystem>
#include <system_error>

#include "converters/base/text.h"
#include "converters/cli/commands.h"

namespace lumen::cli {

namespace {

bool isA(const CLI::ParseError& error, CLI::ExitCodes code) {
  return error.get_exit_code() == static_cast<int>(code);
}

std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// "lumen convert or lumen track" for the commands that have an option; empty if there is none.
std::string commandsWith(const std::string& option, const engine::Engine& commands) {
  std::vector<std::string> found;
  for (const auto& [command, table] : commands.commands())
    if (option.starts_with("--") && table->find(option.substr(2)) != nullptr)
      found.push_back("lumen " + command->name());
  return alternatives(found);
}

/// "--key FILE".
std::string nameWithType(const OptionRow& row) {
  return row.isArgument ? row.name : row.shownName() + " " + row.type;
}

std::string usageLine(const engine::BoundCommand& command) {
  std::string line = "lumen " + command.command->name();
  for (const OptionRow& row : command.table->rows())
    if (row.isArgument) line += " " + row.name + (row.repeats ? "..." : "");
  for (const OptionRow& row : command.table->rows())
    if (!row.isArgument && row.isRequired) line += " " + nameWithType(row);
  return line;
}

std::string unknownOption(const CLI::App& app, const std::string& word,
                          const engine::Engine& commands, const engine::BoundCommand& command) {
  const std::string option = word.substr(0, word.find('='));
  std::string text = option + ": lumen " + command.command->name() + " has no such option";
  const std::string others = commandsWith(option, commands);
  if (!others.empty()) return text + "; it is one of " + others;
  return text + didYouMean(option, optionNames(app));
}

std::string superfluous(const std::string& word, const engine::BoundCommand& command) {
  std::error_code ignored;
  const bool isOfMany =
      command.command->name() == "convert" && std::filesystem::exists(word, ignored);
  return word + ": one argument too many for " + usageLine(command) +
         (isOfMany ? " (lumen batch FOLDER OUT makes a case of every volume of a folder)"
                   : " (a name with spaces needs quotes)");
}

/// The option that an error's text begins with; null if there is none.
const CLI::Option* findOption(const CLI::App& app, const std::string& text) {
  return app.get_option_no_throw(text.substr(0, text.find_first_of(": ")));
}

std::string missingName(const engine::BoundCommand& command, const std::string& name) {
  for (const OptionRow& row : command.table->rows())
    if (row.shownName() == name) return nameWithType(row);
  return name;
}

std::string wrongCount(const CLI::Option& option) {
  const std::string name = option.get_name();
  const std::string type =
      option.get_option_text().empty() ? option.get_type_name() : option.get_option_text();
  const std::size_t count = option.results().size();
  if (count == 0) return name + " needs a value: " + name + " " + type;
  if (option.get_expected_max() == 1) return name + " is given " + std::to_string(count) + " times";
  return name + ": found " + std::to_string(count) + (count == 1 ? " value" : " values") +
         ", expected " + type;
}

Error noConfig(const CLI::App& app) {
  const auto file = app.get_config_ptr()->as<std::string>();
  std::error_code ignored;
  return invalidInput(file + (std::filesystem::is_directory(file, ignored)
                                  ? ": this is a folder, but --config takes a file of options"
                                  : ": there is no such file of options"));
}

std::string complaint(const CLI::App& app, const CLI::ParseError& error,
                      const engine::BoundCommand& command) {
  const std::string text = error.what();
  if (isA(error, CLI::ExitCodes::RequiredError))
    return missingName(command, text.substr(0, text.find(' '))) +
           " is missing; usage: " + usageLine(command);
  const CLI::Option* option = findOption(app, text);
  if (option == nullptr) return text;
  if (isA(error, CLI::ExitCodes::ArgumentMismatch)) return wrongCount(*option);
  if (isA(error, CLI::ExitCodes::ExcludesError))
    return option->get_name() + " and " + text.substr(text.rfind(' ') + 1) + " exclude one another";
  if (isA(error, CLI::ExitCodes::ConversionError))
    return option->get_name() + (option->get_expected_min() == 0
                                     ? " is a switch and takes no value but true or false"
                                     : ": " + text);
  return text;
}

/// The nearest name, as didYouMean(), by the second words alone: the first one makes all commands
/// of a group look alike.
std::string meantInGroup(const std::string& word, const std::string& group,
                         std::vector<std::string> names) {
  for (std::string& name : names) name.erase(0, group.size() + 1);
  const std::string meant = closest(word.substr(group.size() + 1), names);
  return meant.empty() ? "" : "; did you mean " + group + " " + meant + "?";
}

}  // namespace

Error usageError(const CLI::App& app, const CLI::ParseError& error, const engine::Engine& commands,
                 const engine::BoundCommand& command, const CommandConfig& config) {
  if (isA(error, CLI::ExitCodes::FileError)) return noConfig(app);
  const auto left = app.remaining();
  if (isA(error, CLI::ExitCodes::RequiredError) || isA(error, CLI::ExitCodes::ExtrasError)) {
    for (const auto& word : left)
      if (word.size() > 1 && word[0] == '-')
        return {ErrorKind::Usage, unknownOption(app, word, commands, command)};
    if (!left.empty()) return {ErrorKind::Usage, superfluous(left.front(), command)};
  }
  const std::string text = complaint(app, error, command);
  return {ErrorKind::Usage, config.placeOf(text.substr(0, text.find_first_of(": "))) + text};
}

Error unknownCommand(const std::string& word, const engine::Engine& commands) {
  const std::string group = engine::firstWord(word);
  const bool inGroup = group != word && groupSummary(group) != nullptr;
  std::vector<std::string> names;
  for (const auto& [command, table] : commands.commands()) {
    const std::string name = inGroup ? command->name() : engine::firstWord(command->name());
    if ((!inGroup || name.starts_with(group + " ")) && (names.empty() || names.back() != name))
      names.push_back(name);
  }
  const std::string list = "; lumen has " + alternatives(names);
  std::error_code ignored;
  if (word.starts_with('-')) return {ErrorKind::Usage, word + ": options follow a command" + list};
  if (std::filesystem::exists(word, ignored))
    return {ErrorKind::Usage, word + ": this is a file, and a command comes first: lumen info " +
                                  word + " reports what is in it" + list};
  const std::string meant = inGroup ? meantInGroup(word, group, names) : didYouMean(word, names);
  return {ErrorKind::Usage, word + ": there is no such command" + (meant.empty() ? list : meant)};
}

}  // namespace lumen::cli
