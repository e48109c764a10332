// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/command_line.h"

#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "converters/base/message_text.h"
#include "converters/cli/command.h"
#include "converters/cli/command_config.h"
#include "converters/cli/help_text.h"
#include "converters/cli/usage_error.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/report.h"

namespace lumen::app {

namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 failed, 2 usage, 3 invalid input, 4 unsupported, 130 interrupted.";

constexpr const char* kVersion = "lumen " LUMEN_VERSION "\n";

void printError(const std::string& text) {
  std::fprintf(stderr, "lumen: error: %s\n", messageText(text).c_str());
}

int exitCode(ErrorKind kind) {
  return static_cast<int>(kind);
}

void limitThreads(int threads, std::optional<tbb::global_control>& control) {
  if (threads <= 0) return;
  control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  // the toolkit that reads volumes has a thread pool of its own
  setenv("ITK_GLOBAL_DEFAULT_NUMBER_OF_THREADS", std::to_string(threads).c_str(), 1);
}

int execute(Command& command, const CommonOptions& common) {
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
  Context context{common, progress, interrupts};
  return command.run(context);
}

int runCommand(Command& command, int argc, const char* const* argv) {
  CommonOptions common;
  CLI::App app(command.summary(), "lumen " + command.name());
  bindOptions(app, command, common);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer("Example:\n" + command.example() + "\n\n" + kExitCodes);
  const auto config = std::make_shared<CommandConfig>(app, command.name());
  app.config_formatter(config);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    answer(app.help());
    return 0;
  } catch (const CLI::ParseError& error) {
    throw usageError(app, error, command.name(), *config);
  }
  return execute(command, common);
}

std::string listOfCommands(CLI::App& app, const std::string& how) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(how + " --help, or " + how.substr(0, 5) + " help" + how.substr(5) +
             ", tells more, with an example.\n" + kExitCodes);
  return app.help();
}

std::string topLevelHelp() {
  CLI::App app("From an angiography volume to a simulator-ready vessel case.", "lumen");
  app.set_version_flag("-V,--version", "", "Print the version");
  std::string last;
  for (const auto& command : allCommands()) {
    const std::string word = firstWord(command->name());
    const char* const group = groupSummary(word);
    if (word != last) app.add_subcommand(word, group != nullptr ? group : command->summary());
    last = word;
  }
  return listOfCommands(app, "lumen COMMAND");
}

std::string groupHelp(const std::string& word) {
  CLI::App app(groupSummary(word), "lumen " + word);
  for (const auto& command : allCommands())
    if (command->name().starts_with(word + " "))
      app.add_subcommand(command->name().substr(word.size() + 1), command->summary());
  return listOfCommands(app, "lumen " + word + " COMMAND");
}

/// `arguments`: the words of the command's name, then its own.
int runNamed(std::span<const char* const> arguments) {
  std::string name = arguments[0];
  if (groupSummary(name) != nullptr) {
    const std::string second = arguments.size() > 1 ? arguments[1] : "";
    if (second == "--help" || second == "-h") {
      answer(groupHelp(name));
      return 0;
    }
    if (second.empty()) {
      std::fputs(groupHelp(name).c_str(), stderr);
      throw Error(ErrorKind::Usage, "lumen " + name + ": a command is missing");
    }
    name += " " + second;
    arguments = arguments.subspan(1);
  }
  for (const auto& command : allCommands())
    if (command->name() == name)
      return runCommand(*command, static_cast<int>(arguments.size()), arguments.data());
  throw unknownCommand(name);
}

int dispatch(std::span<const char* const> words) {
  const std::string first = words.size() > 1 ? words[1] : "";
  if (words.size() < 2) {
    std::fputs(topLevelHelp().c_str(), stderr);
    throw Error(ErrorKind::Usage, "a command is missing");
  }
  if (first == "help" && words.size() > 2) {
    std::vector<const char*> question(words.begin() + 2, words.end());
    question.push_back("--help");
    return runNamed(question);
  }
  if (first == "help" || first == "--help" || first == "-h") {
    answer(topLevelHelp());
    return 0;
  }
  if (first == "version" || first == "--version" || first == "-V") {
    answer(kVersion);
    return 0;
  }
  return runNamed(words.subspan(1));
}

}  // namespace

void bindOptions(CLI::App& app, Command& command, CommonOptions& common) {
  command.bind(app);
  app.add_option("--threads", common.threads, "Threads to run on; 0: all cores")
      ->type_name("N")
      ->check(wholeIn(0, 1024))
      ->capture_default_str();
  auto* quiet = app.add_flag("--quiet", common.quiet, "Print errors and the asked-for answer only");
  app.add_flag("--verbose", common.verbose, "Also print details")->excludes(quiet);
  app.add_flag("--strict", common.strict,
               "Every warning is an error: exit with 3 and write nothing");
  app.add_flag("--json", common.json, "Answer with one JSON object on standard output");
  app.set_config(
         "--config", "",
         "Options from a file of lines such as \"inlier-rate = 0.6\"; the command line wins")
      ->type_name("FILE")
      ->check(fileName());
}

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
    printError("there is not enough memory; --crop reads a part of a volume");
  } catch (const std::exception& error) {
    printError(std::string("unexpected: ") + error.what());
  }
  return exitCode(ErrorKind::Failed);
}

}  // namespace lumen::app
