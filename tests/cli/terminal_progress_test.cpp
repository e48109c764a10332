// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/terminal_progress.h"

#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::test {

namespace {

/// Output of a TerminalProgress on a stream that is no terminal.
class Recorder {
public:
  explicit Recorder(bool bar, Verbosity verbosity = Verbosity::Normal,
                    std::chrono::milliseconds interval = std::chrono::milliseconds(0))
      : m_stream(std::tmpfile()), progress({m_stream, bar, verbosity, interval, interval}) {}
  ~Recorder() { std::fclose(m_stream); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  std::string text() {
    std::fflush(m_stream);
    std::rewind(m_stream);
    std::string all;
    for (int c = std::fgetc(m_stream); c != EOF; c = std::fgetc(m_stream))
      all += static_cast<char>(c);
    return all;
  }

private:
  std::FILE* m_stream;

public:
  TerminalProgress progress;
};

constexpr std::chrono::milliseconds kNever{3'600'000};

}  // namespace

TEST(FormatDuration, ChoosesTheUnitBySize) {
  EXPECT_EQ(formatDuration(6.6), "7 s");
  EXPECT_EQ(formatDuration(65), "1:05");
  EXPECT_EQ(formatDuration(7400), "2:03:20");
}

TEST(FormatProgress, EstimatesTheRestFromTheDonePart) {
  EXPECT_EQ(formatProgress(10, 40, 5), "25 %  10 of 40  15 s left");
}

TEST(FormatProgress, SaysNothingOfTheRestBeforeAnythingIsDone) {
  EXPECT_EQ(formatProgress(0, 40, 5), "0 %  0 of 40");
}

TEST(FormatProgress, CountsWhenTheTotalIsUnknown) {
  EXPECT_EQ(formatProgress(3, 0, 5), "3  5 s");
}

TEST(TerminalProgressTest, AShortStageIsOnePlainLine) {
  Recorder recorder(false, Verbosity::Normal, kNever);
  recorder.progress.begin("fitting", 3);
  for (int i = 0; i < 3; ++i) recorder.progress.advance();
  recorder.progress.end();
  EXPECT_EQ(recorder.text(), "fitting: done in 0 s (3)\n");
}

TEST(TerminalProgressTest, PlainLinesComeOncePerInterval) {
  Recorder recorder(false);
  recorder.progress.begin("fitting", 2);
  recorder.progress.advance();
  EXPECT_EQ(recorder.text(), "fitting: 50 %  1 of 2  0 s left\n");
}

TEST(TerminalProgressTest, TheBarIsRedrawnInPlaceAndClearedAtTheEnd) {
  Recorder recorder(true, Verbosity::Normal, kNever);
  recorder.progress.begin("fitting", 2);
  recorder.progress.end();
  EXPECT_EQ(recorder.text(),
            "\r\x1b[Kfitting  [........................]  0 %  0 of 2"
            "\r\x1b[Kfitting: done in 0 s (2)\n");
}

TEST(TerminalProgressTest, QuietPrintsNothing) {
  Recorder recorder(true, Verbosity::Quiet);
  recorder.progress.begin("fitting", 1);
  recorder.progress.advance();
  recorder.progress.warn("careful");
  recorder.progress.detail("by the way");
  recorder.progress.end();
  EXPECT_EQ(recorder.text(), "");
}

TEST(TerminalProgressTest, DetailsNeedVerboseAndWarningsDoNot) {
  Recorder normal(false), verbose(false, Verbosity::Verbose);
  for (Recorder* recorder : {&normal, &verbose}) {
    recorder->progress.warn("careful");
    recorder->progress.detail("by the way");
  }
  EXPECT_EQ(normal.text(), "lumen: warning: careful\n");
  EXPECT_EQ(verbose.text(), "lumen: warning: careful\nlumen: by the way\n");
}

TEST(TerminalProgressTest, ThreadsMayAdvanceAtOnce) {
  Recorder recorder(false, Verbosity::Normal, kNever);
  recorder.progress.begin("fitting", 4000);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) recorder.progress.advance();
    });
  for (auto& thread : threads) thread.join();
  recorder.progress.end();
  EXPECT_EQ(recorder.text(), "fitting: done in 0 s (4000)\n");
}

}  // namespace lumen::test
