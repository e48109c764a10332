// SPDX-License-Identifier: Apache-2.0
// Declared in commands.h and completion.h.
#include <algorithm>
#include <map>

#include "converters/cli/commands.h"
#include "converters/cli/completion.h"
#include "converters/cli/help_topics.h"
#include "converters/engine/file_format.h"

namespace lumen::cli {

namespace {

/// "glb, lumen" as words.
std::vector<std::string> wordsIn(const std::string& list) {
  std::vector<std::string> words{""};
  for (const char c : list)
    if (c == ' ')
      words.emplace_back();
    else if (c != ',')
      words.back() += c;
  return words;
}

std::vector<std::string> valuesOf(const OptionRow& row) {
  if (row.name == "from") return wordsIn(engine::formatNames(engine::canRead));
  if (row.name == "to") return wordsIn(engine::formatNames(engine::canWrite));
  return row.words;
}

void addOption(const OptionRow& row, std::vector<CompletedOption>& options) {
  if (row.isArgument) return;
  options.push_back({row.shownName(), row.help, !row.isFlag(), valuesOf(row)});
  if (!row.negative.empty()) options.push_back({"--" + row.negative, row.help, false, {}});
}

const std::map<std::string, std::string (*)(const Completion&)>& scripts() {
  static const std::map<std::string, std::string (*)(const Completion&)> scripts = {
      {"bash", bashScript}, {"fish", fishScript}, {"zsh", zshScript}};
  return scripts;
}

class CompletionCommand : public engine::Command {
public:
  [[nodiscard]] std::string name() const override { return "completion"; }
  [[nodiscard]] std::string summary() const override {
    return "Print a script that completes commands, options and formats in a shell";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen completion bash > ~/.local/share/bash-completion/completions/lumen\n"
           "  lumen completion zsh > ~/.zfunc/_lumen   # a folder that is in $fpath\n"
           "  lumen completion fish > ~/.config/fish/completions/lumen.fish";
  }

  void addRows(OptionTable& table) override {
    table.argument("SHELL", &m_shell, "bash, fish or zsh", checkAmong({"bash", "fish", "zsh"}));
  }

  engine::Answer run(const engine::RunContext& context) override {
    std::string script = scripts().at(m_shell)(completionOf(context.engine));
    return {{{"script", script}}, std::move(script), 0, true};
  }

private:
  std::string m_shell;
};

}  // namespace

Completion completionOf(const engine::Engine& commands) {
  Completion completion;
  CommonOptions common;
  OptionTable shared;
  common.addRows(shared);
  for (const auto& [command, table] : commands.commands()) {
    const std::string first = engine::firstWord(command->name());
    const char* const group = groupSummary(first);
    if (group != nullptr && (completion.groups.empty() || completion.groups.back().name != first))
      completion.groups.push_back({first, group, {}});
    CompletedCommand& made =
        completion.commands.emplace_back(CompletedCommand{command->name(), command->summary(), {}});
    made.options.push_back({"--help", "Print the help of the command", false, {}});
    for (const OptionTable* rows :
         {static_cast<const OptionTable*>(table.get()), &std::as_const(shared)})
      for (const OptionRow& row : rows->rows()) addOption(row, made.options);
    addOption(configRow(), made.options);
  }
  for (const HelpTopic& topic : helpTopics())
    completion.topics.push_back({topic.name, topic.title, {}});
  return completion;
}

std::unique_ptr<engine::Command> makeCompletionCommand() {
  return std::make_unique<CompletionCommand>();
}

}  // namespace lumen::cli
