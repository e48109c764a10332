// SPDX-License-Identifier: Apache-2.0
// Declared in completion.h.
#include <sstream>

#include "converters/cli/completion.h"

namespace lumen::cli {

namespace {

std::string bashWords(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string bashNames(const std::vector<CompletedCommand>& commands) {
  std::vector<std::string> names;
  for (const CompletedCommand& command : commands) names.push_back(command.name);
  return bashWords(names);
}

bool isOfGroup(const CompletedCommand& command) {
  return command.name.find(' ') != std::string::npos;
}

/// The pattern of a command among its first two words.
std::string bashPattern(const CompletedCommand& command) {
  return "\"" + command.name + (isOfGroup(command) ? "\"" : " \"*");
}

/// Cases of words before the cursor: those that an option takes.
std::string bashValues(const Completion& completion) {
  std::ostringstream cases;
  for (const CompletedCommand& command : completion.commands)
    for (const CompletedOption& option : command.options)
      if (!option.values.empty())
        cases << "      \"" << command.name << "\"*\" " << option.name << "\") words=\""
              << bashWords(option.values) << "\" ;;\n";
  return cases.str();
}

std::string bashOptions(const Completion& completion) {
  std::ostringstream cases;
  for (const CompletedCommand& command : completion.commands) {
    std::vector<std::string> names;
    for (const CompletedOption& option : command.options) names.push_back(option.name);
    cases << "      " << bashPattern(command) << ") words=\"" << bashWords(names) << "\" ;;\n";
  }
  return cases.str();
}

}  // namespace

std::string bashScript(const Completion& completion) {
  std::ostringstream script;
  std::vector<std::string> names;
  for (const CompletedCommand& command : completion.commands)
    if (!isOfGroup(command)) names.push_back(command.name);
  names.push_back(bashNames(completion.groups));
  script << "# bash: eval \"$(lumen completion bash)\"\n"
            "_lumen() {\n"
            "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
            "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         << "    words=\"" << bashWords(names) << " help --help --version\"\n"
         << "  elif [ \"$COMP_CWORD\" -eq 2 ] && [ \"${COMP_WORDS[1]}\" = help ]; then\n"
         << "    words=\"" << bashWords(names) << " " << bashNames(completion.topics) << "\"\n";
  for (const CompletedCommand& group : completion.groups) {
    script << "  elif [ \"$COMP_CWORD\" -eq 2 ] && [ \"${COMP_WORDS[1]}\" = " << group.name
           << " ]; then\n    words=\"";
    for (const CompletedCommand& command : completion.commands)
      if (command.name.starts_with(group.name + " "))
        script << command.name.substr(group.name.size() + 1) << " ";
    script << "--help\"\n";
  }
  script << "  elif [[ $word == -* ]]; then\n"
            "    case \"${COMP_WORDS[1]} ${COMP_WORDS[2]}\" in\n"
         << bashOptions(completion)
         << "    esac\n"
            "  else\n"
            "    case \"${COMP_WORDS[1]} ${COMP_WORDS[2]} $before\" in\n"
         << bashValues(completion)
         << "    esac\n"
            "  fi\n"
            "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
            "}\n"
            "complete -o default -F _lumen lumen\n";
  return script.str();
}

}  // namespace lumen::cli
