// SPDX-License-Identifier: Apache-2.0
#include "converters/app/command_line.h"

#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "converters/app/command.h"
#include "converters/app/command_config.h"
#include "converters/app/report.h"

namespace lumen::app {

namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 failed, 2 usage, 3 invalid input, 4 unsupported, 130 interrupted.";

std::vector<std::string> commandNames() {
  std::vector<std::string> names;
  for (const auto& command : allCommands()) names.push_back(command->name());
  return names;
}

void printError(const std::string& text) {
  std::fprintf(stderr, "lumen: error: %s\n", text.c_str());
}

int exitCode(ErrorKind kind) {
  return static_cast<int>(kind);
}

/// Prints help, the version or a complaint about the arguments.
int answerParseError(const CLI::App& app, const CLI::ParseError& error,
                     const std::string& helpCommand) {
  if (error.get_name() == "CallForHelp") {
    answer(app.help());
    return 0;
  }
  if (error.get_name() == "CallForVersion") {
    answer(std::string(error.what()) + "\n");
    return 0;
  }
  printError(error.what());
  std::fprintf(stderr, "lumen: %s tells how it is used\n", helpCommand.c_str());
  const bool missingConfig = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::FileError);
  return exitCode(missingConfig ? ErrorKind::InvalidInput : ErrorKind::Usage);
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
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, verbosity));
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
  const std::string title = "lumen " + command.name();
  CommonOptions common;
  CLI::App app(command.summary(), title);
  bindOptions(app, command, common);
  app.get_formatter()->column_width(36);
  for (CLI::Option* option : app.get_options())
    if (option->get_positional()) option->option_text(" ");
  app.footer("Example:\n" + command.example() + "\n\n" + kExitCodes);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answerParseError(app, error, title + " --help");
  }
  return execute(command, common);
}

int runTopLevel(int argc, const char* const* argv,
                std::vector<std::unique_ptr<Command>>& commands) {
  CLI::App app("From an angiography volume to a simulator-ready vessel case.", "lumen");
  app.set_version_flag("--version", std::string("lumen ") + LUMEN_VERSION, "Print the version");
  for (const auto& command : commands) app.add_subcommand(command->name(), command->summary());
  app.footer("lumen COMMAND --help tells more, with an example.\n" + std::string(kExitCodes));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answerParseError(app, error, "lumen --help");
  }
  throw Error(ErrorKind::Usage, "a command is needed; lumen --help lists them");
}

int dispatch(int argc, const char* const* argv) {
  auto commands = allCommands();
  for (const auto& command : commands)
    if (argc > 1 && command->name() == argv[1]) return runCommand(*command, argc - 1, argv + 1);
  if (argc > 1 && argv[1][0] != '-') {
    std::string known;
    for (const auto& command : commands) known.append(" ").append(command->name());
    throw Error(ErrorKind::Usage,
                std::string(argv[1]) + ": there is no such command; lumen has" + known);
  }
  return runTopLevel(argc, argv, commands);
}

}  // namespace

void bindOptions(CLI::App& app, Command& command, CommonOptions& common) {
  command.bind(app);
  app.add_option("--threads", common.threads, "Threads to run on; 0: all cores")
      ->type_name("N")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  auto* quiet = app.add_flag("--quiet", common.quiet, "Print errors and the asked-for answer only");
  app.add_flag("--verbose", common.verbose, "Also print details")->excludes(quiet);
  app.add_flag("--json", common.json, "Answer with one JSON object on standard output");
  app.set_config(
         "--config", "",
         "Options from a file of lines such as \"inlier-rate = 0.6\"; the command line wins")
      ->type_name("FILE");
  app.config_formatter(std::make_shared<CommandConfig>(command.name(), commandNames()));
  app.allow_config_extras(CLI::config_extras_mode::error);
}

int runCommandLine(int argc, const char* const* argv) {
  try {
    return dispatch(argc, argv);
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
