// SPDX-License-Identifier: Apache-2.0
// Ctrl-C in the middle of the work.
#include "converters/cli/interrupt.h"

#include <chrono>
#include <thread>

#include <signal.h>
#include <unistd.h>

#include "formats/case/atomic_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Names = std::vector<std::string>;

// tracking with that number of trials takes hours
const Names kEndlessTrack = {"track",        "tube.nrrd", "tube.lumen",    "--seeds",
                             "seeds.json",   "--verbose", "--min-trials",  "1000000",
                             "--max-trials", "1000000",   "--inlier-rate", "1"};
const Names kLargePhantom = {"phantom", "patient", "large.nrrd", "--size", "448", "--verbose"};

}  // namespace

using InterruptTest = TubeTest;

TEST_F(InterruptTest, InterruptedTrackingExitsWith130AndLeavesNoFile) {
  const Outcome stopped = lumenWithSignal(kEndlessTrack, SIGINT);
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_EQ(stopped.out, "");
  EXPECT_EQ(entries(), (Names{"seeds.json", "truth.lumen", "tube.nrrd"}));
}

TEST_F(InterruptTest, TerminationCountsAsAnInterrupt) {
  EXPECT_EQ(lumenWithSignal(kEndlessTrack, SIGTERM).code, 130);
}

TEST_F(InterruptTest, TheEndOfTheTerminalCountsAsAnInterrupt) {
  const Outcome stopped = lumenWithSignal(kEndlessTrack, SIGHUP);
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_EQ(entries(), (Names{"seeds.json", "truth.lumen", "tube.nrrd"}));
}

TEST_F(InterruptTest, AKilledRunLeavesNothingThatTheNextOneDoesNotRemove) {
  EXPECT_EQ(lumenWithSignal(kEndlessTrack, SIGKILL).code, 1000 + SIGKILL);
  // what a run that is killed while it writes leaves
  const pid_t writer = ::fork();
  if (writer == 0) {
    const auto pending = formats::PendingFile::beside(path("tube.lumen"));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  ASSERT_GE(entries().size(), 4U);  // the killed run may have been at a file, too
  ASSERT_EQ(lumen({"phantom", "tube", "tube.nrrd", "--size", "32"}).code, 0);
  EXPECT_EQ(entries(), (Names{"seeds.json", "truth.lumen", "tube.nrrd"}));
}

TEST_F(InterruptTest, ASecondInterruptEndsTheProgramToo) {
  EXPECT_EQ(lumenWithSignal(kEndlessTrack, SIGINT, 2).code, 130);
}

TEST_F(InterruptTest, AnInterruptedPhantomLeavesNoFile) {
  const Outcome stopped = lumenWithSignal(kLargePhantom, SIGINT);
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_EQ(entries(), (Names{"seeds.json", "truth.lumen", "tube.nrrd"}));
}

TEST_F(InterruptTest, AnInterruptLeavesTheExistingOutputAlone) {
  write("tube.lumen", "precious");
  EXPECT_EQ(lumenWithSignal(kEndlessTrack, SIGINT).code, 130);
  EXPECT_EQ(read("tube.lumen"), "precious");
}

using InterruptGuardTest = CliTest;

TEST_F(InterruptGuardTest, WorkThatDoesNotStopIsEndedAndItsTemporaryFileRemoved) {
  EXPECT_EXIT(
      {
        Progress progress;
        InterruptGuard guard(progress);
        const auto pending = formats::PendingFile::beside(path("volume.nrrd"));
        write("volume.nrrd", "whole");
        kill(getpid(), SIGINT);
        std::this_thread::sleep_for(std::chrono::hours(1));
      },
      ::testing::ExitedWithCode(130), "interrupted");
  EXPECT_EQ(entries(), Names{"volume.nrrd"});
}

TEST_F(InterruptGuardTest, TheEndOfTheTerminalIsPassedOverUnderNohup) {
  EXPECT_EXIT(
      {
        signal(SIGHUP, SIG_IGN);
        Progress progress;
        {
          InterruptGuard guard(progress);
          kill(getpid(), SIGHUP);
          std::this_thread::sleep_for(std::chrono::milliseconds(300));
        }
        _exit(progress.cancelled() ? 1 : 7);
      },
      ::testing::ExitedWithCode(7), "");
}

TEST_F(InterruptGuardTest, WorkThatStopsByItselfIsLeftAlone) {
  EXPECT_EXIT(
      {
        Progress progress;
        {
          InterruptGuard guard(progress);
          kill(getpid(), SIGINT);
          while (!progress.cancelled()) std::this_thread::yield();
        }
        _exit(7);
      },
      ::testing::ExitedWithCode(7), "");
}

}  // namespace lumen::test
