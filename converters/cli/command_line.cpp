// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/command_line.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/cli/commands.h"
#include "converters/cli/help_text.h"
#include "converters/cli/help_topics.h"
#include "converters/cli/interrupt.h"
#include "converters/cli/parser.h"
#include "converters/cli/terminal_progress.h"
#include "converters/cli/usage_error.h"
#include "converters/engine/operation_process.h"

namespace lumen::cli {

namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 failed, 2 usage, 3 invalid input, 4 unsupported, 130 interrupted.";

void printError(const std::string& text) {
  std::fprintf(stderr, "lumen: error: %s\n", messageText(text).c_str());
}

int exitCode(ErrorKind kind) {
  return static_cast<int>(kind);
}

void limitThreads(int threads, std::optional<tbb::global_control>& control) {
  if (threads <= 0) return;
  control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
}

void print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw failed("standard output cannot be written to");
}

void print(const engine::Answer& answer, const CommonOptions& common) {
  using Json = engine::Json;
  if (!common.json) {
    if (answer.isAsked || !common.quiet) print(answer.text);
  } else if (!answer.json.is_null()) {
    print(answer.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
}

/// The program that runs, or the script that starts it: a folder that brings its own C library
/// starts lib/ld-linux*, the loader, by bin/lumen.
std::filesystem::path thisProgram() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  if (program.filename().string().starts_with("ld-linux"))
    return (program.parent_path() / "../bin/lumen").lexically_normal();
  return program;
}

/// A terminal around work: progress, Ctrl-C, threads.
template <class Work>
int atTerminal(const engine::Engine& commands, const CommonOptions& common, const Work& work) {
  const Verbosity verbosity = common.quiet     ? Verbosity::Quiet
                              : common.verbose ? Verbosity::Verbose
                                               : Verbosity::Normal;
  auto style = TerminalProgress::detectStyle(stderr, verbosity);
  style.strict = common.strict;
  TerminalProgress progress(style);
  InterruptGuard interrupts(progress);
  std::optional<tbb::global_control> control;
  limitThreads(common.threads, control);
  const int available = tbb::this_task_arena::max_concurrency();
  progress.detail(
      std::string("lumen " LUMEN_VERSION ", threads: ").append(std::to_string(available)));
  engine::RunContext context(commands, progress);
  context.program = thisProgram();
  addViewerPage(context);
  context.threads = common.threads;
  context.strict = common.strict;
  context.answerEarly = [&](const engine::Answer& answer) { print(answer, common); };
  return work(context);
}

int runCommand(const engine::Engine& commands, const engine::BoundCommand& bound, int argc,
               const char* const* argv) {
  CommonOptions common;
  OptionTable commonTable;
  common.addRows(commonTable);
  CommandParser parser(commands, bound, commonTable);
  try {
    parser.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print(parser.help("Example:\n" + bound.command->example() + "\n\n" + kExitCodes));
    return 0;
  }
  return atTerminal(commands, common, [&](const engine::RunContext& context) {
    const engine::Answer answer = commands.run(bound, context);
    print(answer, common);
    return answer.code;
  });
}

/// The side of `lumen library build` that does one operation.
int runOperation(const engine::Engine& commands, const char* file) {
  const engine::RunSettings settings = engine::operationSettings(file);
  CommonOptions common;
  common.threads = settings.threads;
  common.strict = settings.strict;
  return atTerminal(commands, common, [&](const engine::RunContext& context) {
    return engine::runOperationFile(file, context);
  });
}

std::string listOfCommands(CLI::App& app, const std::string& how, const std::string& more = "") {
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(how + " --help, or " + how.substr(0, 5) + " help" + how.substr(5) +
             " prints more, with an example.\n" + more + kExitCodes);
  return app.help();
}

std::string topLevelHelp(const engine::Engine& commands) {
  CLI::App app("From an angiography volume to a simulator-ready vessel case.", "lumen");
  app.set_version_flag(
      "-V,--version", "",
      "Print the version; with --json also those of the file formats, and the parts");
  std::string last;
  for (const auto& [command, table] : commands.commands()) {
    const std::string word = engine::firstWord(command->name());
    const char* const group = groupSummary(word);
    if (word != last) app.add_subcommand(word, group != nullptr ? group : command->summary());
    last = word;
  }
  return listOfCommands(app, "lumen COMMAND",
                        "lumen help TOPIC prints a part of the manual:\n" + listOfTopics());
}

std::string groupHelp(const engine::Engine& commands, const std::string& word) {
  CLI::App app(groupSummary(word), "lumen " + word);
  for (const auto& [command, table] : commands.commands())
    if (command->name().starts_with(word + " "))
      app.add_subcommand(command->name().substr(word.size() + 1), command->summary());
  return listOfCommands(app, "lumen " + word + " COMMAND");
}

/// `arguments`: the words of the command's name, then its own.
int runNamed(const engine::Engine& commands, std::span<const char* const> arguments) {
  std::string name = arguments[0];
  if (groupSummary(name) != nullptr) {
    const std::string second = arguments.size() > 1 ? arguments[1] : "";
    if (second == "--help" || second == "-h") {
      print(groupHelp(commands, name));
      return 0;
    }
    if (second.empty()) {
      std::fputs(groupHelp(commands, name).c_str(), stderr);
      throw Error(ErrorKind::Usage, "lumen " + name + ": a command is missing");
    }
    name += " " + second;
    arguments = arguments.subspan(1);
  }
  const engine::BoundCommand bound = commands.find(name);
  if (!bound.command) throw unknownCommand(name, commands);
  return runCommand(commands, bound, static_cast<int>(arguments.size()), arguments.data());
}

/// `question`: words after help, of which there is one.
int printHelp(const engine::Engine& commands, std::span<const char* const> question) {
  const std::string word = question.front();
  const bool isCommand = groupSummary(word) != nullptr || commands.find(word).command != nullptr;
  if (isCommand || word.starts_with('-')) {
    std::vector<const char*> words(question.begin(), question.end());
    words.push_back("--help");
    return runNamed(commands, words);
  }
  const std::string text = topicText(word);
  if (text.empty()) throw unknownTopic(word, commands);
  if (question.size() > 1)
    throw Error(ErrorKind::Usage,
                std::string(question[1]) + ": one argument too many for lumen help " + word);
  print(text);
  return 0;
}

/// `more`: words after --version, of which there is one.
void printVersion(std::span<const char* const> more) {
  for (const std::string_view word : more)
    if (word != kOption.json.shown())
      throw Error(ErrorKind::Usage, "\"" + std::string(word) +
                                        "\" is no option of the version: it has only " +
                                        kOption.json.shown());
  print(more.empty() ? versionLine() : versionJson());
}

int dispatch(std::span<const char* const> words) {
  const engine::Engine commands = allCommands();
  const std::string first = words.size() > 1 ? words[1] : "";
  if (words.size() < 2) {
    std::fputs(topLevelHelp(commands).c_str(), stderr);
    throw Error(ErrorKind::Usage, "a command is missing");
  }
  if (first == "help" && words.size() > 2) return printHelp(commands, words.subspan(2));
  if (first == "help" || first == "--help" || first == "-h") {
    print(topLevelHelp(commands));
    return 0;
  }
  if (first == "version" || first == "--version" || first == "-V") {
    printVersion(words.subspan(2));
    return 0;
  }
  if (first == engine::kOperationWord && words.size() == 3) return runOperation(commands, words[2]);
  return runNamed(commands, words.subspan(1));
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
  reportFileSizeLimit();
  try {
    return dispatch({argv, static_cast<std::size_t>(argc)});
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled)
      std::fputs("lumen: interrupted\n", stderr);
    else
      printError(error.what());
    return exitCode(error.kind());
  } catch (const std::bad_alloc&) {
    printError("there is not enough memory; " + kOption.crop.shown() + " reads a part of a volume");
  } catch (const std::exception& error) {
    printError(std::string("unexpected: ") + error.what());
  }
  return exitCode(ErrorKind::Failed);
}

}  // namespace lumen::cli
