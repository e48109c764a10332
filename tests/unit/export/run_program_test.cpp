// SPDX-License-Identifier: Apache-2.0
#include "converters/common/run_program.h"

#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "converters/common/error.h"

namespace lumen::convert {

namespace {

std::filesystem::path program(const std::string& name) {
  const auto path = installedProgram(name);
  EXPECT_TRUE(path) << name;
  return path.value_or("");
}

}  // namespace

TEST(RunProgram, TellsHowItEnds) {
  const PrivateFolder folder;
  const Progress progress;
  EXPECT_EQ(runProgram(program("true"), {}, folder.path(), 60, progress), ProgramEnd::Done);
  EXPECT_EQ(runProgram(program("false"), {}, folder.path(), 60, progress), ProgramEnd::Refused);
  EXPECT_EQ(runProgram("/nowhere/at-all", {}, folder.path(), 60, progress), ProgramEnd::Refused);
}

TEST(RunProgram, RunsInItsFolderAndTakesArgumentsAsTheyAre) {
  const PrivateFolder folder;
  const std::string name = "a b; $HOME";
  EXPECT_EQ(runProgram(program("touch"), {name}, folder.path(), 60, {}), ProgramEnd::Done);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / name));
}

TEST(RunProgram, EndsWhatTakesTooLong) {
  const PrivateFolder folder;
  EXPECT_EQ(runProgram(program("sleep"), {"1000"}, folder.path(), 0, {}), ProgramEnd::TookTooLong);
}

TEST(RunProgram, StopsWhenTheUserDoes) {
  const PrivateFolder folder;
  Progress progress;
  std::thread user([&progress] { progress.cancel(); });
  EXPECT_THROW(runProgram(program("sleep"), {"1000"}, folder.path(), 10000, progress), Error);
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
