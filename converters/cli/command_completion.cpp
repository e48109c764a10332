// SPDX-License-Identifier: Apache-2.0
// Declared in commands.h.

#include <map>
#include <sstream>

#include "converters/cli/commands.h"
#include "converters/engine/file_format.h"

namespace lumen::cli {

namespace {

/// "--from --to --seeds ...": the long names of a command's options.
std::string optionNames(const OptionTable& own) {
  CommonOptions common;
  OptionTable shared;
  common.addRows(shared);
  std::string names = "--help";
  for (const OptionTable* table : {&own, static_cast<const OptionTable*>(&shared)})
    for (const OptionRow& row : table->rows()) {
      if (row.isArgument) continue;
      names += " " + row.shownName();
      if (!row.negative.empty()) names += " --" + row.negative;
    }
  return names + " --" + configRow().name;
}

std::string spaced(std::string list) {
  std::erase(list, ',');
  return list;
}

/// File names are completed by the shell itself wherever nothing here answers.
std::string bashScript(const engine::Engine& commands) {
  std::map<std::string, std::string> seconds;  // keys: the word of their group
  std::string names, last;
  std::ostringstream options, groups;
  for (const auto& [command, table] : commands.commands()) {
    const std::string first = engine::firstWord(command->name());
    const bool isGroup = groupSummary(first) != nullptr;
    if (first != last) names += (names.empty() ? "" : " ") + first;
    if (isGroup) seconds[first] += command->name().substr(first.size());
    options << "      \"" << command->name() << (isGroup ? "\"" : " \"*") << ") words=\""
            << optionNames(*table) << "\" ;;\n";
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
         << "    words=\"" << spaced(engine::formatNames(engine::canRead)) << "\"\n"
         << "  elif [ \"$before\" = --to ]; then\n"
         << "    words=\"" << spaced(engine::formatNames(engine::canWrite)) << "\"\n"
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

class CompletionCommand : public engine::Command {
public:
  [[nodiscard]] std::string name() const override { return "completion"; }
  [[nodiscard]] std::string summary() const override {
    return "Print a script that completes commands, options and formats in a shell";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen completion bash > ~/.local/share/bash-completion/completions/lumen";
  }

  void addRows(OptionTable& table) override {
    table.argument("SHELL", &m_shell, "bash", checkAmong({"bash"}));
  }

  engine::Answer run(const engine::RunContext& context) override {
    std::string script = bashScript(context.engine);
    return {{{"script", script}}, std::move(script), 0, true};
  }

private:
  std::string m_shell;
};

}  // namespace

std::unique_ptr<engine::Command> makeCompletionCommand() {
  return std::make_unique<CompletionCommand>();
}

}  // namespace lumen::cli
