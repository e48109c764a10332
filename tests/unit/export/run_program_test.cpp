// SPDX-License-Identifier: Apache-2.0
#include "converters/base/run_program.h"

#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

std::filesystem::path program(const std::string& name) {
  const auto path = installedProgram(name);
  EXPECT_TRUE(path) << name;
  return path.value_or("");
}

ProgramResult run(const std::string& name, const std::vector<std::string>& arguments,
                  const std::filesystem::path& input = {}, unsigned seconds = 60,
                  const Progress& progress = {}) {
  const PrivateFolder folder;
  return runProgram({program(name), arguments, folder.path(), seconds, input, false, {}}, progress);
}

}  // namespace

TEST(RunProgram, TellsHowItEnds) {
  const PrivateFolder folder;
  EXPECT_EQ(run("true", {}).end, ProgramEnd::Done);
  EXPECT_EQ(run("false", {}).end, ProgramEnd::Refused);
  EXPECT_EQ(runProgram({"/nowhere/at-all", {}, folder.path(), 60, {}, false, {}}, {}).end,
            ProgramEnd::Refused);
}

TEST(RunProgram, RunsInItsFolderAndTakesArgumentsAsTheyAre) {
  const PrivateFolder folder;
  const std::string name = "a b; $HOME";
  EXPECT_EQ(runProgram({program("touch"), {name}, folder.path(), 60, {}, false, {}}, {}).end,
            ProgramEnd::Done);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / name));
}

TEST(RunProgram, KeepsTheBeginningOfWhatIsPrinted) {
  EXPECT_EQ(run("echo", {"said"}).output, "said\n");
  EXPECT_NE(run("cat", {"/no/such/file"}).errors.find("/no/such/file"), std::string::npos);
  // more than a pipe holds: the program is not held up, and the memory is bounded
  const ProgramResult many = run("seq", {"100000"});
  EXPECT_EQ(many.end, ProgramEnd::Done);
  EXPECT_EQ(many.output.size(), 4096U);
}

TEST(RunProgram, AddsToALogWhatItPrintsAsErrorsAndTellsItsCode) {
  const PrivateFolder folder;
  ProgramCall call;
  call.program = program("sh");
  call.folder = folder.path();
  call.seconds = 60;
  call.log = folder.path() / "log";
  for (const std::string text : {"first", "second"}) {
    call.arguments = {"-c", "echo " + text + " >&2; exit 3"};
    const ProgramResult result = runProgram(call, {});
    EXPECT_EQ(result.end, ProgramEnd::Refused);
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.errors, "");
  }
  std::ifstream in(call.log);
  std::string first, second;
  in >> first >> second;
  EXPECT_EQ(first + " " + second, "first second");
  call.log = folder.path() / "missing" / "log";
  EXPECT_THROW((void)runProgram(call, {}), Error);
}

TEST(RunProgram, ReadsItsInputFromAFileAndOtherwiseNothing) {
  const PrivateFolder folder;
  std::ofstream(folder.path() / "in") << "what it reads";
  EXPECT_EQ(run("cat", {}, folder.path() / "in").output, "what it reads");
  EXPECT_EQ(run("cat", {}).output, "");
  EXPECT_THROW(run("cat", {}, folder.path() / "missing"), Error);
}

TEST(RunProgram, EndsWhatTakesTooLong) {
  EXPECT_EQ(run("sleep", {"1000"}, {}, 0).end, ProgramEnd::TookTooLong);
}

TEST(RunProgram, StopsWhenTheUserDoes) {
  Progress progress;
  std::thread user([&progress] { progress.cancel(); });
  EXPECT_THROW(run("sleep", {"1000"}, {}, 10000, progress), Error);
  user.join();
}

TEST(PrivateFolder, IsForThisUserOnlyAndGoneAfterwards) {
  std::filesystem::path path;
  {
    const PrivateFolder folder;
    path = folder.path();
    EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms::owner_all);
    std::ofstream(path / "file") << "x";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(InstalledProgram, IsNothingForANameThatIsNot) {
  EXPECT_FALSE(installedProgram("no-program-has-this-name"));
}

}  // namespace lumen::convert
