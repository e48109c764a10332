// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/connection.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kStopLook{200};

/// The descriptor of a connection. The HTTP library keeps it to itself, but of the loopback
/// interface the other end's port is that of one connection only.
std::optional<int> findDescriptor(int remotePort) {
  std::error_code error;
  for (fs::directory_iterator entry("/proc/self/fd", error), end; !error && entry != end;
       entry.increment(error)) {
    const int descriptor = std::atoi(entry->path().filename().c_str());
    sockaddr_in other{};
    socklen_t size = sizeof other;
    if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&other), &size) == 0 &&
        other.sin_family == AF_INET && ntohs(other.sin_port) == remotePort)
      return descriptor;
  }
  return std::nullopt;
}

bool isClosed(int descriptor) {
  char byte = 0;
  return recv(descriptor, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

}  // namespace

void whileConnected(int remotePort, const std::function<void(Progress&)>& work) {
  Progress progress;
  const std::optional<int> descriptor = findDescriptor(remotePort);
  if (!descriptor) return work(progress);
  std::mutex mutex;
  std::condition_variable wake;
  bool done = false;
  std::thread watcher([&] {
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, kStopLook, [&done] { return done; }))
      if (isClosed(*descriptor)) return progress.cancel();
  });
  struct Join {
    std::function<void()> end;
    ~Join() { end(); }
  };
  const Join join{[&] {
    {
      const std::lock_guard lock(mutex);
      done = true;
    }
    wake.notify_all();
    watcher.join();
  }};
  work(progress);
}

}  // namespace lumen::viewer
