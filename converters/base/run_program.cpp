// SPDX-License-Identifier: Apache-2.0
#include "converters/base/run_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

// Exit code of a child that cannot start its program, as of a shell.
constexpr int kNotStarted = 127;

constexpr std::size_t kKept = 4096;  // bytes kept of its output

/// A pipe for a program's output, read without waiting.
class Printed {
public:
  explicit Printed(bool isShown) : m_isShown(isShown) {
    if (pipe2(m_ends.data(), O_CLOEXEC) != 0) throw failed("no pipe can be made");
    fcntl(m_ends[0], F_SETFL, O_NONBLOCK);
  }
  ~Printed() {
    close(m_ends[0]);
    closeInner();
  }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;

  [[nodiscard]] int inner() const { return m_ends[1]; }
  void closeInner() {
    if (m_ends[1] >= 0) close(m_ends[1]);
    m_ends[1] = -1;
  }
  /// Drains the pipe, so that the program need not wait.
  void take() {
    std::array<char, kKept> bytes{};
    for (ssize_t n = 0; (n = read(m_ends[0], bytes.data(), bytes.size())) > 0;) {
      const auto size = static_cast<std::size_t>(n);
      if (m_isShown && write(STDERR_FILENO, bytes.data(), size) < 0) m_isShown = false;
      m_text.append(bytes.data(), std::min(size, kKept - m_text.size()));
    }
  }
  [[nodiscard]] const std::string& text() const { return m_text; }

private:
  std::array<int, 2> m_ends{-1, -1};
  bool m_isShown;
  std::string m_text;
};

/// Restores the user's terminal: a program that is killed while it asks for a password leaves it
/// without echo.
class TerminalState {
public:
  TerminalState() : m_terminal(open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY)) {
    m_isKnown = m_terminal >= 0 && tcgetattr(m_terminal, &m_state) == 0;
  }
  ~TerminalState() {
    if (m_isKnown) tcsetattr(m_terminal, TCSANOW, &m_state);
    if (m_terminal >= 0) close(m_terminal);
  }
  TerminalState(const TerminalState&) = delete;
  TerminalState& operator=(const TerminalState&) = delete;

private:
  int m_terminal;
  bool m_isKnown = false;
  termios m_state{};
};

/// An open file, closed with this object; -1 for none.
struct Opened {
  explicit Opened(int opened) : descriptor(opened) {}
  ~Opened() {
    if (descriptor >= 0) close(descriptor);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  const int descriptor;
};

/// fork() of one thread at a time: libraries that end their threads before it and start them again
/// behind it, as ITK does, cannot do so for two at once.
pid_t forkAlone() {
  static std::mutex others;
  const std::lock_guard lock(others);
  return fork();
}

/// Data for the child, prepared before it starts. Streams that are -1 stay unchanged.
struct StartedProgram {
  const char* program;
  char* const* arguments;
  const char* folder;
  std::array<int, 3> streams;  ///< standard input, output, errors
  std::optional<std::uint64_t> mostFileBytes;
};

/// Uses only calls that are allowed between fork and exec in a process with several threads.
[[noreturn]] void runChild(const StartedProgram& child) {
  // Ctrl-C reaches both; the parent kills the child, and so does the parent's own end
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  if (child.mostFileBytes) {
    const rlimit most{*child.mostFileBytes, *child.mostFileBytes};
    setrlimit(RLIMIT_FSIZE, &most);
  }
  if (chdir(child.folder) != 0) _exit(kNotStarted);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (child.streams[static_cast<std::size_t>(stream)] >= 0)
      dup2(child.streams[static_cast<std::size_t>(stream)], stream);
  execv(child.program, child.arguments);
  _exit(kNotStarted);
}

struct Outcome {
  ProgramEnd end = ProgramEnd::Crashed;
  int code = 0;
};

/// Waits for the child, or kills it: at `latest`, or when the user has cancelled.
Outcome outcome(pid_t child, std::chrono::steady_clock::time_point latest, Printed& output,
                Printed& errors, const Progress& progress) {
  auto pause = std::chrono::microseconds(200);
  int status = 0;
  while (true) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    const int waited = errno;
    for (Printed* const printed : {&output, &errors}) printed->take();
    if (ended == child) break;
    if (ended < 0 && waited != EINTR) return {};
    const bool isLate = std::chrono::steady_clock::now() > latest;
    if (isLate || progress.cancelled()) {
      kill(child, SIGKILL);
      while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
      return {ProgramEnd::TookTooLong, 0};
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(20000));
  }
  if (!WIFEXITED(status)) return {};
  const int code = WEXITSTATUS(status);
  return {code == 0 ? ProgramEnd::Done : ProgramEnd::Refused, code};
}

int openInput(const ProgramCall& call) {
  if (call.asksUser) return -1;
  const std::filesystem::path file = call.input.empty() ? "/dev/null" : call.input;
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw failed(file.string() + ": cannot be read");
  return descriptor;
}

/// `how`: O_APPEND, or O_TRUNC. -1 without a file.
int openWritten(const std::filesystem::path& file, int how) {
  if (file.empty()) return -1;
  const int descriptor = open(file.c_str(), O_WRONLY | how | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw failed(file.string() + ": cannot be written");
  return descriptor;
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

ProgramResult runProgram(const ProgramCall& call, const Progress& progress) {
  std::vector<std::string> words{call.program.string()};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Opened input(openInput(call)), log(openWritten(call.log, O_APPEND)),
      written(openWritten(call.output, O_TRUNC));
  Printed output(false), errors(call.asksUser);
  const std::optional<TerminalState> terminal =
      call.asksUser ? std::optional<TerminalState>(std::in_place) : std::nullopt;
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(call.seconds);
  const pid_t child = forkAlone();
  if (child < 0) throw failed(call.program.filename().string() + " cannot be started");
  if (child == 0)
    runChild({words.front().c_str(),
              pointers.data(),
              call.folder.c_str(),
              {input.descriptor, written.descriptor >= 0 ? written.descriptor : output.inner(),
               log.descriptor >= 0 ? log.descriptor : errors.inner()},
              call.mostFileBytes});
  output.closeInner();
  errors.closeInner();
  const auto [end, code] = outcome(child, latest, output, errors, progress);
  progress.check();
  return {end, code, output.text(), errors.text()};
}

}  // namespace lumen::convert
