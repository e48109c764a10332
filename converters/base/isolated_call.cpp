// SPDX-License-Identifier: Apache-2.0
#include "converters/base/isolated_call.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "converters/base/error.h"

namespace lumen::convert {
namespace {

// The sanitizers reserve terabytes of addresses, which any limit would forbid.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif
#else
constexpr bool kLimitsMemory = true;
#endif

/// Memory that a child shares with its parent.
class SharedBuffer {
public:
  explicit SharedBuffer(std::size_t size)
      : m_size(size),
        m_at(mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (m_at == MAP_FAILED) throw failed("there is no memory for what a library decodes");
  }
  ~SharedBuffer() { munmap(m_at, m_size); }
  SharedBuffer(const SharedBuffer&) = delete;
  SharedBuffer& operator=(const SharedBuffer&) = delete;
  [[nodiscard]] std::span<std::byte> bytes() const {
    return {static_cast<std::byte*>(m_at), m_size};
  }

private:
  std::size_t m_size;
  void* m_at;
};

/// A child process, killed and reaped with this object.
class Child {
public:
  explicit Child(pid_t id) : m_id(id) {}
  ~Child() {
    if (m_id <= 0) return;
    kill(m_id, SIGKILL);
    while (waitpid(m_id, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// True once the child has ended, with its status.
  bool hasEnded(int& status) {
    if (waitpid(m_id, &status, WNOHANG) != m_id) return false;
    m_id = 0;
    return true;
  }

private:
  pid_t m_id;
};

void limit(int what, std::size_t value) {
  rlimit bound{};
  getrlimit(static_cast<__rlimit_resource>(what), &bound);
  bound.rlim_cur = bound.rlim_max = std::min<rlim_t>(value, bound.rlim_max);
  setrlimit(static_cast<__rlimit_resource>(what), &bound);
}

std::size_t addressSpace() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void runChild(std::span<std::byte> out, std::size_t addresses, unsigned seconds,
                           const std::function<bool(std::span<std::byte>)>& fill) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU})
    std::signal(signal, SIG_DFL);
  // Ctrl-C reaches both; the parent kills the child, and so does the parent's own end
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds);
  if (kLimitsMemory && addresses > 0) limit(RLIMIT_AS, addresses);
  // a failed assertion, or a sanitizer, would print
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  bool done = false;
  try {
    done = fill(out);
  } catch (...) {
    done = false;
  }
  _exit(done ? 0 : 1);
}

}  // namespace

IsolatedEnd callIsolated(std::span<std::byte> out, std::size_t memory, unsigned seconds,
                         const std::function<bool(std::span<std::byte>)>& fill,
                         const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const SharedBuffer buffer(out.size());
  const std::size_t before = addressSpace();
  const pid_t id = fork();
  if (id < 0) throw failed("a process to decode in cannot be started");
  if (id == 0) runChild(buffer.bytes(), before > 0 ? before + memory : 0, seconds, fill);
  Child child(id);
  // a child that waits forever uses no processor time
  const auto latest = Clock::now() + std::chrono::seconds(10 * seconds);
  auto pause = std::chrono::microseconds(100);
  int status = 0;
  while (!child.hasEnded(status)) {
    progress.check();
    if (Clock::now() > latest) return IsolatedEnd::Crashed;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(5000));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) > 1) return IsolatedEnd::Crashed;
  if (WEXITSTATUS(status) == 1) return IsolatedEnd::Refused;
  std::copy(buffer.bytes().begin(), buffer.bytes().end(), out.begin());
  return IsolatedEnd::Done;
}

}  // namespace lumen::convert
