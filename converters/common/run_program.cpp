// SPDX-License-Identifier: Apache-2.0
#include "converters/common/run_program.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "converters/common/error.h"

namespace lumen::convert {

namespace {

// A program that cannot be started ends with this, as a shell's would.
constexpr int kNotStarted = 127;

/// Only calls that are allowed between fork and exec in a process of several threads.
[[noreturn]] void runChild(const char* program, char* const* arguments, const char* folder) {
  // Ctrl-C goes to both; the parent ends this one, and its own end does too
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0 || chdir(folder) != 0) _exit(kNotStarted);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  execv(program, arguments);
  _exit(kNotStarted);
}

/// Waits for the child, or ends it: when `latest` has come, or the user has cancelled.
ProgramEnd outcome(pid_t child, std::chrono::steady_clock::time_point latest,
                   const Progress& progress) {
  auto pause = std::chrono::microseconds(200);
  int status = 0;
  while (true) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) return ProgramEnd::Crashed;
    const bool isLate = std::chrono::steady_clock::now() > latest;
    if (isLate || progress.cancelled()) {
      kill(child, SIGKILL);
      while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
      progress.check();
      return ProgramEnd::TookTooLong;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(20000));
  }
  if (!WIFEXITED(status)) return ProgramEnd::Crashed;
  return WEXITSTATUS(status) == 0 ? ProgramEnd::Done : ProgramEnd::Refused;
}

}  // namespace

PrivateFolder::PrivateFolder() {
  std::error_code error;
  std::string text = (std::filesystem::temp_directory_path(error) / "lumen-XXXXXX").string();
  if (error || mkdtemp(text.data()) == nullptr)
    throw failed("a folder for temporary files cannot be made");
  m_path = text;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(m_path, ignored);
}

std::optional<std::filesystem::path> installedProgram(const std::string& name) {
  const char* const list = std::getenv("PATH");
  std::string_view rest = list == nullptr ? "" : list;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code error;
    if (path.is_absolute() && std::filesystem::is_regular_file(path, error) &&
        access(path.c_str(), X_OK) == 0)
      return path;
  }
  return {};
}

ProgramEnd runProgram(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder, unsigned seconds,
                      const Progress& progress) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  const pid_t child = fork();
  if (child < 0) throw failed(program.filename().string() + " cannot be started");
  if (child == 0) runChild(words.front().c_str(), pointers.data(), folder.c_str());
  return outcome(child, latest, progress);
}

}  // namespace lumen::convert
