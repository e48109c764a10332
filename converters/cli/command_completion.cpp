// SPDX-License-Identifier: Apache-2.0
// lumen completion: what a shell offers when the tabulator key is pressed.
#include <map>
#include <sstream>

#include "converters/cli/command_line.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/file_format.h"
#include "converters/engine/report.h"

namespace lumen::app {

namespace {

/// "--from --to --seeds ...": the long names of a command's options.
std::string optionNames(Command& command) {
  CLI::App app;
  CommonOptions common;
  bindOptions(app, command, common);
  std::string names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      names += (names.empty() ? "--" : " --") + name;
  return names;
}

std::string spaced(std::string list) {
  std::erase(list, ',');
  return list;
}

/// File names are completed by the shell itself wherever nothing here answers.
std::string bashScript() {
  std::map<std::string, std::string> seconds;  // by the word of their group
  std::string names, last;
  std::ostringstream options, groups;
  for (const auto& command : allCommands()) {
    const std::string first = firstWord(command->name());
    const bool isGroup = groupSummary(first) != nullptr;
    if (first != last) names += (names.empty() ? "" : " ") + first;
    if (isGroup) seconds[first] += command->name().substr(first.size());
    options << "      \"" << command->name() << (isGroup ? "\"" : " \"*") << ") words=\""
            << optionNames(*command) << "\" ;;\n";
    last = first;
  }
  for (const auto& [first, words] : seconds)
    groups << "  elif [ \"$COMP_CWORD\" -eq 2 ] && [ \"${COMP_WORDS[1]}\" = " << first
           << " ]; then\n    words=\"" << words.substr(1) << " --help\"\n";
  std::ostringstream script;
  script << "# bash: eval \"$(lumen completion bash)\"\n"
            "_lumen() {\n"
            "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
            "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         << "    words=\"" << names << " help --help --version\"\n"
         << groups.str() << "  elif [ \"$before\" = --from ]; then\n"
         << "    words=\"" << spaced(formatNames(canRead)) << "\"\n"
         << "  elif [ \"$before\" = --to ]; then\n"
         << "    words=\"" << spaced(formatNames(canWrite)) << "\"\n"
         << "  elif [[ $word == -* ]]; then\n"
            "    case \"${COMP_WORDS[1]} ${COMP_WORDS[2]}\" in\n"
         << options.str()
         << "    esac\n"
            "  fi\n"
            "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
            "}\n"
            "complete -o default -F _lumen lumen\n";
  return script.str();
}

class CompletionCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "completion"; }
  [[nodiscard]] std::string summary() const override {
    return "Print a script that completes commands, options and formats in a shell";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen completion bash > ~/.local/share/bash-completion/completions/lumen";
  }

  void bind(CLI::App& app) override {
    app.add_option("SHELL", m_shell, "bash")
        ->required()
        ->configurable(false)
        ->check(oneOf(std::vector<std::string>{"bash"}));
  }

  int run(Context& context) override {
    if (context.common.json)
      answerJson({{"script", bashScript()}});
    else
      answer(bashScript());
    return 0;
  }

private:
  std::string m_shell;
};

}  // namespace

std::unique_ptr<Command> makeCompletionCommand() {
  return std::make_unique<CompletionCommand>();
}

}  // namespace lumen::app
