// SPDX-License-Identifier: Apache-2.0
// Declared in completion.h.
#include <sstream>

#include "converters/cli/completion.h"

namespace lumen::cli {

namespace {

/// A text within single quotes.
std::string zshQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// 'name:one line' for _describe.
std::string zshEntry(const std::string& name, const std::string& summary) {
  return " " + zshQuoted(name + ":" + summary);
}

/// The commands whose names begin with `first`, without it; all commands of one word for "".
std::string zshCommands(const Completion& completion, const std::string& first) {
  std::string entries;
  for (const CompletedCommand& command : completion.commands) {
    const bool isMeant = first.empty() ? command.name.find(' ') == std::string::npos
                                       : command.name.starts_with(first);
    if (isMeant) entries += zshEntry(command.name.substr(first.size()), command.summary);
  }
  if (first.empty())
    for (const CompletedCommand& group : completion.groups)
      entries += zshEntry(group.name, group.summary);
  return entries;
}

std::string zshPattern(const CompletedCommand& command) {
  const bool isOfGroup = command.name.find(' ') != std::string::npos;
  return "\"" + command.name + (isOfGroup ? "\"" : " \"*");
}

std::string zshValues(const Completion& completion) {
  std::ostringstream cases;
  for (const CompletedCommand& command : completion.commands)
    for (const CompletedOption& option : command.options) {
      if (option.values.empty()) continue;
      cases << "    \"" << command.name << "\"*\" " << option.name << "\") compadd --";
      for (const std::string& value : option.values) cases << " " << value;
      cases << "; return ;;\n";
    }
  return cases.str();
}

std::string zshOptions(const Completion& completion) {
  std::ostringstream cases;
  for (const CompletedCommand& command : completion.commands) {
    cases << "    " << zshPattern(command) << ") entries=(";
    for (const CompletedOption& option : command.options)
      cases << zshEntry(option.name, option.help);
    cases << " ) ;;\n";
  }
  return cases.str();
}

}  // namespace

std::string zshScript(const Completion& completion) {
  std::ostringstream script;
  script << "#compdef lumen\n"
            "# zsh: source <(lumen completion zsh), or its output as the file _lumen in $fpath\n"
            "_lumen() {\n"
            "  local -a entries\n"
            "  if (( CURRENT == 2 )); then\n"
            "    entries=("
         << zshCommands(completion, "")
         << zshEntry("help", "Print the help of a command, or a part of the manual")
         << " )\n"
            "  elif (( CURRENT == 3 )) && [[ $words[2] == help ]]; then\n"
            "    entries=("
         << zshCommands(completion, "");
  for (const CompletedCommand& topic : completion.topics)
    script << zshEntry(topic.name, topic.summary);
  script << " )\n";
  for (const CompletedCommand& group : completion.groups)
    script << "  elif (( CURRENT == 3 )) && [[ $words[2] == " << group.name
           << " ]]; then\n    entries=(" << zshCommands(completion, group.name + " ") << " )\n";
  script << "  elif [[ $words[CURRENT] == -* ]]; then\n"
            "    case \"$words[2] $words[3]\" in\n"
         << zshOptions(completion)
         << "    esac\n"
            "  else\n"
            "    case \"$words[2] $words[3] $words[CURRENT-1]\" in\n"
         << zshValues(completion)
         << "    esac\n"
            "    _files\n"
            "    return\n"
            "  fi\n"
            "  _describe lumen entries\n"
            "}\n"
            "if [[ $funcstack[1] == _lumen ]]; then _lumen \"$@\"; else compdef _lumen lumen; fi\n";
  return script.str();
}

}  // namespace lumen::cli
