// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/run_lumen.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

using namespace std::chrono_literals;

[[noreturn]] void becomeLumen(const std::vector<std::string>& arguments, const fs::path& folder,
                              const fs::path& streams) {
  std::vector<char*> argv{const_cast<char*>("lumen")};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const int in = open("/dev/null", O_RDONLY);
  const int out = creat((streams / "out").c_str(), 0600);
  const int err = creat((streams / "err").c_str(), 0600);
  if (dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(folder.c_str()) != 0)
    _exit(126);
  execv(LUMEN_EXECUTABLE, argv.data());
  _exit(127);
}

int exitCode(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/// The exit code; kills the process after ten minutes.
int waitFor(pid_t child) {
  int status = 0;
  for (int i = 0; i < 60000; ++i) {
    if (waitpid(child, &status, WNOHANG) == child) return exitCode(status);
    std::this_thread::sleep_for(10ms);
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return exitCode(status);
}

void waitForOutput(const fs::path& file) {
  std::error_code ignored;
  for (int i = 0; i < 3000; ++i) {
    if (fs::exists(file, ignored) && fs::file_size(file, ignored) > 0) return;
    std::this_thread::sleep_for(10ms);
  }
}

}  // namespace

Outcome CliTest::lumen(const std::vector<std::string>& arguments) const {
  return runHere(arguments, m_folder.path);
}

Outcome CliTest::lumenProgram(const std::vector<std::string>& arguments) const {
  const pid_t child = fork();
  if (child == 0) becomeLumen(arguments, m_folder.path, m_streams.path);
  const int code = waitFor(child);
  return {code, readFile(m_streams.path / "out"), readFile(m_streams.path / "err")};
}

Outcome CliTest::lumenWithSignal(const std::vector<std::string>& arguments, int signalNumber,
                                 int times) const {
  fs::remove(m_streams.path / "err");
  const pid_t child = fork();
  if (child == 0) becomeLumen(arguments, m_folder.path, m_streams.path);
  waitForOutput(m_streams.path / "err");
  for (int i = 0; i < times; ++i) {
    kill(child, signalNumber);
    std::this_thread::sleep_for(20ms);
  }
  const int code = waitFor(child);
  return {code, readFile(m_streams.path / "out"), readFile(m_streams.path / "err")};
}

std::string CliTest::read(const std::string& name) const {
  return readFile(path(name));
}

void CliTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

std::vector<std::string> CliTest::entries() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(m_folder.path))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void CliTest::make(const std::vector<std::string>& arguments) const {
  const Outcome made = lumen(arguments);
  ASSERT_EQ(made.code, 0) << made.err;
}

void CliTest::fillOnce(const std::string& name, const std::function<void()>& fill) const {
  static std::map<std::string, TemporaryFolder> kept;
  const auto copy = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
  if (const auto found = kept.find(name); found != kept.end())
    return fs::copy(found->second.path, m_folder.path, copy);
  fill();
  if (!HasFatalFailure()) fs::copy(m_folder.path, kept[name].path, copy);
}

void TubeTest::SetUp() {
  fillOnce("tube", [this] {
    make({"phantom", "tube", "tube.nrrd", "--size", "64", "--truth", "truth.lumen", "--seeds",
          "seeds.json"});
  });
}

void FittedTubeTest::SetUp() {
  TubeTest::SetUp();
  fillOnce("fitted tube", [this] {
    make({"convert", "tube.nrrd", "tube.lumen", "--seeds", "seeds.json"});
  });
}

}  // namespace lumen::test
