// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/http_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include "converters/base/error.h"

namespace lumen::viewer {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kHead{2000};  // a head arrives at once on the loopback interface
constexpr milliseconds kEachMiB{1000};
constexpr milliseconds kWrite{5000};  // between two writes to a page that does not read

class RequestStream : public httplib::Stream {
public:
  explicit RequestStream(socket_t socket) : m_socket(socket) {}

  [[nodiscard]] bool is_readable() const override {
    return m_begin < m_end || isReady(POLLIN, remaining());
  }

  [[nodiscard]] bool is_writable() const override {
    char byte = 0;
    return isReady(POLLOUT, kWrite) && recv(m_socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT) != 0;
  }

  ssize_t read(char* to, std::size_t size) override {
    if (m_begin == m_end) {
      if (!is_readable()) return -1;
      const ssize_t count = recv(m_socket, m_buffer.data(), m_buffer.size(), 0);
      if (count <= 0) return count;
      m_begin = 0;
      m_end = static_cast<std::size_t>(count);
      m_arrived += m_end;
    }
    const std::size_t count = std::min(size, m_end - m_begin);
    std::memcpy(to, m_buffer.data() + m_begin, count);
    m_begin += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    return is_writable() ? send(m_socket, from, size, MSG_NOSIGNAL) : -1;
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    address(getpeername, ip, port);
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    address(getsockname, ip, port);
  }
  [[nodiscard]] socket_t socket() const override { return m_socket; }

private:
  /// Until the request is late; zero if it is.
  [[nodiscard]] milliseconds remaining() const {
    const auto until = m_start + kHead + kEachMiB * static_cast<std::int64_t>(m_arrived >> 20);
    return std::max(std::chrono::duration_cast<milliseconds>(until - Clock::now()),
                    milliseconds(0));
  }

  [[nodiscard]] bool isReady(short event, milliseconds most) const {
    pollfd one{m_socket, event, 0};
    return poll(&one, 1, static_cast<int>(most.count())) > 0;
  }

  template <class Name>
  void address(Name name, std::string& ip, int& port) const {
    sockaddr_in place{};
    socklen_t size = sizeof place;
    std::array<char, INET_ADDRSTRLEN> text{};
    if (name(m_socket, reinterpret_cast<sockaddr*>(&place), &size) != 0) return;
    if (inet_ntop(AF_INET, &place.sin_addr, text.data(), text.size()) == nullptr) return;
    ip = text.data();
    port = ntohs(place.sin_port);
  }

  const socket_t m_socket;
  const Clock::time_point m_start = Clock::now();
  std::array<char, 1 << 14> m_buffer{};
  std::size_t m_begin = 0, m_end = 0;  ///< bytes of the buffer that nobody has read yet
  std::uint64_t m_arrived = 0;
};

}  // namespace

bool HttpServer::process_and_close_socket(socket_t socket) {
  RequestStream stream(socket);
  bool closed = false;
  const bool answered = process_request(stream, true, closed, nullptr);
  shutdown(socket, SHUT_RDWR);
  close(socket);
  return answered;
}

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

std::string randomToken() {
  std::array<unsigned char, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size()))
    throw failed(std::string("the system gives no random numbers: ") + std::strerror(errno));
  std::string text;
  for (const unsigned char byte : bits)
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  return text;
}

bool sameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

}  // namespace lumen::viewer
