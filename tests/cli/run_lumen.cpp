// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/run_lumen.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

using namespace std::chrono_literals;

fs::path makeFolder() {
  std::string pattern = (fs::temp_directory_path() / "lumen-cli-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return pattern;
}

std::string readFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

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

CliTest::CliTest() : m_folder(makeFolder()), m_streams(makeFolder()) {}

CliTest::~CliTest() {
  fs::remove_all(m_folder);
  fs::remove_all(m_streams);
}

Outcome CliTest::lumen(const std::vector<std::string>& arguments) const {
  const pid_t child = fork();
  if (child == 0) becomeLumen(arguments, m_folder, m_streams);
  int status = 0;
  waitpid(child, &status, 0);
  return {exitCode(status), readFile(m_streams / "out"), readFile(m_streams / "err")};
}

Outcome CliTest::lumenWithSignal(const std::vector<std::string>& arguments, int signalNumber,
                                 int times) const {
  fs::remove(m_streams / "err");
  const pid_t child = fork();
  if (child == 0) becomeLumen(arguments, m_folder, m_streams);
  waitForOutput(m_streams / "err");
  for (int i = 0; i < times; ++i) {
    kill(child, signalNumber);
    std::this_thread::sleep_for(20ms);
  }
  const int code = waitFor(child);
  return {code, readFile(m_streams / "out"), readFile(m_streams / "err")};
}

std::string CliTest::read(const std::string& name) const {
  return readFile(path(name));
}

void CliTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

std::vector<std::string> CliTest::entries() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(m_folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void TubeTest::SetUp() {
  const Outcome made = lumen({"phantom", "tube", "tube.nrrd", "--size", "64", "--truth",
                              "truth.lumen", "--seeds", "seeds.json"});
  ASSERT_EQ(made.code, 0) << made.err;
}

}  // namespace lumen::test
