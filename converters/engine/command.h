// SPDX-License-Identifier: Apache-2.0
// Commands: the work that the program can be asked for. A command states its options as rows and
// answers with facts; it neither prints nor knows who asked.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/memory_files.h"
#include "converters/base/options/operation.h"
#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"

namespace lumen::engine {

/// Exit code 3: an input is invalid. It is for complete answers about an input that is not valid.
constexpr int kInvalidCode = static_cast<int>(ErrorKind::InvalidInput);

/// The outcome of a command, in both forms.
struct Answer {
  Json json;
  std::string text;      ///< whole lines
  int code = 0;          ///< exit code
  bool isAsked = false;  ///< the text is the command's purpose, so even --quiet prints it
};

class Engine;

/// Settings of a command, which hold for all operations within it.
struct RunSettings {
  int threads = 0;      ///< 0: all cores
  bool strict = false;  ///< a warning is an error: Progress::warn() throws
  /// Takes an answer that is due before the command ends.
  std::function<void(const Answer&)> answerEarly = [](const auto&) {};
  /// Inputs and outputs that are in memory; null: all are files.
  MemoryFiles* memory = nullptr;
  /// The program that runs an operation in a process of its own (operation_process.h). Empty: there
  /// is none, and such operations run in this process.
  std::filesystem::path program;
};

/// Engine, progress, settings and rows of a command that runs.
struct RunContext : RunSettings {
  RunContext(const Engine& ownEngine, Progress& ownProgress, RunSettings settings = {})
      : RunSettings(std::move(settings)), engine(ownEngine), progress(ownProgress) {}
  /// The context of an operation within this command, with a progress of its own.
  [[nodiscard]] RunContext within(Progress& other) const { return {engine, other, *this}; }

  const Engine& engine;
  Progress& progress;
  const OptionTable* table = nullptr;  ///< rows of the command that runs
};

class Command {
public:
  Command() = default;
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// One word, or a group's word and another: "library add".
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string summary() const = 0;  ///< one line
  [[nodiscard]] virtual std::string example() const = 0;  ///< shell lines for the end of the help
  /// Adds the rows of the command's own options, whose values are stored in this object.
  virtual void addRows(OptionTable& table) = 0;
  /// Does the work after the rows are set. Throws lumen::Error.
  virtual Answer run(const RunContext& context) = 0;
};

/// A command with its rows, which are stored in it.
struct BoundCommand {
  std::unique_ptr<Command> command;
  std::unique_ptr<OptionTable> table;
};

/// The program's commands, in the order of the help.
class Engine {
public:
  using Maker = std::function<std::unique_ptr<Command>()>;

  void add(Maker maker) { m_makers.push_back(std::move(maker)); }
  /// Every command, new.
  [[nodiscard]] std::vector<BoundCommand> commands() const;
  /// The command of that name, new; null where there is none.
  [[nodiscard]] BoundCommand find(const std::string& name) const;
  /// Runs the command. Throws Error(Usage) for an unknown command, argument or option, or
  /// a value that is not allowed, and as the command.
  [[nodiscard]] Answer run(const Operation& operation, const RunContext& context) const;
  /// Runs a command whose rows are set. Throws as the command.
  [[nodiscard]] Answer run(const BoundCommand& bound, const RunContext& context) const;

private:
  std::vector<Maker> m_makers;
};

/// All commands but those of the viewer and of the terminal.
Engine makeEngine();

/// Sets the rows by the operation, whose files may be in `memory`. Throws Error(Usage).
void setRows(OptionTable& table, const Operation& operation, MemoryFiles* memory = nullptr);

/// Throws Error(Usage) for options that are given and exclude one another.
void requireCompatible(const OptionTable& table);

/// The context of an operation within a command: its rows word fields and values.
inline operations::Context operationContext(const RunContext& context) {
  return operationContext(context.progress, context.table);
}

/// The first word of a command's name.
inline std::string firstWord(const std::string& name) {
  return name.substr(0, name.find(' '));
}

}  // namespace lumen::engine
