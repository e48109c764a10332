// SPDX-License-Identifier: Apache-2.0
// The list of commands. Each is defined in command_NAME.cpp.
#include "converters/cli/command.h"

namespace lumen::app {

std::unique_ptr<Command> makeConvertCommand();
std::unique_ptr<Command> makeExportCommand();
std::unique_ptr<Command> makeTrackCommand();
std::unique_ptr<Command> makeFitCommand();
std::unique_ptr<Command> makeInfoCommand();
std::unique_ptr<Command> makeValidateCommand();
std::unique_ptr<Command> makeCompareCommand();
std::unique_ptr<Command> makeCheckCommand();
std::unique_ptr<Command> makePictureCommand();
std::unique_ptr<Command> makeLibraryCheckCommand();
std::unique_ptr<Command> makeLibrarySignCommand();
std::unique_ptr<Command> makeLibraryVerifyCommand();
std::unique_ptr<Command> makeReportCommand();
std::unique_ptr<Command> makeViewCommand();  // viewer/server
std::unique_ptr<Command> makeLibraryInitCommand();
std::unique_ptr<Command> makeLibraryAddCommand();
std::unique_ptr<Command> makeLibraryRemoveCommand();
std::unique_ptr<Command> makeLibraryExtractCommand();
std::unique_ptr<Command> makeLibraryListCommand();
std::unique_ptr<Command> makeLibraryIndexCommand();
std::unique_ptr<Command> makeLibraryBuildCommand();
std::unique_ptr<Command> makeLibrarySampleCommand();
std::unique_ptr<Command> makePhantomCommand();
std::unique_ptr<Command> makeCompletionCommand();

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  for (const auto make :
       {makeConvertCommand,       makeExportCommand,         makeTrackCommand,
        makeFitCommand,           makeInfoCommand,           makeValidateCommand,
        makeCompareCommand,       makeCheckCommand,          makePictureCommand,
        makeReportCommand,        makeLibraryInitCommand,    makeLibraryAddCommand,
        makeLibraryRemoveCommand, makeLibraryExtractCommand, makeLibraryListCommand,
        makeLibraryCheckCommand,  makeLibrarySignCommand,    makeLibraryVerifyCommand,
        makeLibraryIndexCommand,  makeLibraryBuildCommand,   makeLibrarySampleCommand,
        makeViewCommand,          makePhantomCommand,        makeCompletionCommand})
    commands.push_back(make());
  return commands;
}

const char* groupSummary(const std::string& word) {
  return word == "library" ? "Make, change, check, sign and publish libraries of cases" : nullptr;
}

}  // namespace lumen::app
