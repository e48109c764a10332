// SPDX-License-Identifier: Apache-2.0
// Declared in completion.h.
#include <sstream>

#include "converters/cli/completion.h"

namespace lumen::cli {

namespace {

/// A text within single quotes.
std::string fishQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return quoted + "'";
}

/// A line that offers a word after the words of `before`, of which `lumen` is none.
std::string fishWord(const std::string& before, const CompletedCommand& command) {
  const std::string word = before.empty() ? command.name : command.name.substr(before.size() + 1);
  return "complete -c lumen -n '__lumen_after " + std::string(before.empty() ? "" : before) +
         "' -f -a " + word + " -d " + fishQuoted(command.summary) + "\n";
}

std::string fishOption(const std::string& command, const CompletedOption& option) {
  std::string line = "complete -c lumen -n '__lumen_within " + command + "' -l " +
                     option.name.substr(2) + " -d " + fishQuoted(option.help);
  if (!option.values.empty()) {
    std::string words;
    for (const std::string& value : option.values) words += (words.empty() ? "" : " ") + value;
    line += " -x -a " + fishQuoted(words);
  } else if (option.takesValue) {
    line += " -r";
  }
  return line + "\n";
}

constexpr const char* kFishHead =
    "# fish: lumen completion fish | source\n"
    "# whether the words between lumen and the cursor are these\n"
    "function __lumen_after\n"
    "    set -l words (commandline -opc)\n"
    "    test \"$words[2..-1]\" = \"$argv\"\n"
    "end\n"
    "# whether the first words after lumen are these\n"
    "function __lumen_within\n"
    "    set -l words (commandline -opc)\n"
    "    set -l last (math (count $argv) + 1)\n"
    "    test (count $words) -ge $last; and test \"$words[2..$last]\" = \"$argv\"\n"
    "end\n";

}  // namespace

std::string fishScript(const Completion& completion) {
  std::ostringstream script;
  script << kFishHead << fishWord("", {"help", "Print the help of a command, or a topic", {}});
  for (const CompletedCommand& group : completion.groups) {
    script << fishWord("", group) << fishWord("help", {"help " + group.name, group.summary, {}});
    for (const CompletedCommand& command : completion.commands)
      if (command.name.starts_with(group.name + " ")) script << fishWord(group.name, command);
  }
  for (const CompletedCommand& command : completion.commands) {
    if (command.name.find(' ') == std::string::npos)
      script << fishWord("", command)
             << fishWord("help", {"help " + command.name, command.summary, {}});
    for (const CompletedOption& option : command.options)
      script << fishOption(command.name, option);
  }
  for (const CompletedCommand& topic : completion.topics)
    script << fishWord("help", {"help " + topic.name, topic.summary, {}});
  return script.str();
}

}  // namespace lumen::cli
