// SPDX-License-Identifier: Apache-2.0
// An HTTP server on the loopback interface that answers each connection with the next of its
// scripts.
#pragma once

#include <cstddef>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lumen::convert {

struct Script {
  std::string answer;     ///< head and body, as they go over the wire
  bool isSilent = false;  ///< then the connection stays open, until the client closes it
};

class ScriptedServer {
public:
  explicit ScriptedServer(std::vector<Script> scripts) : m_scripts(std::move(scripts)) {
    m_socket = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(m_socket, generic, size) != 0 || listen(m_socket, 8) != 0 ||
        getsockname(m_socket, generic, &size) != 0)
      return;
    m_port = ntohs(address.sin_port);
    m_thread = std::thread([this] { serve(); });
  }
  ~ScriptedServer() {
    shutdown(m_socket, SHUT_RDWR);
    if (m_thread.joinable()) m_thread.join();
    close(m_socket);
  }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  [[nodiscard]] std::string address(const std::string& path) const {
    return "http://127.0.0.1:" + std::to_string(m_port) + path;
  }
  /// The heads of the requests, after the last one has been answered.
  [[nodiscard]] const std::vector<std::string>& requests() const { return m_requests; }

private:
  void serve() {
    for (const Script& script : m_scripts) {
      const int client = accept4(m_socket, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0) return;
      m_requests.push_back(requestOf(client));
      for (std::size_t sent = 0; sent < script.answer.size();) {
        const ssize_t n =
            send(client, script.answer.data() + sent, script.answer.size() - sent, MSG_NOSIGNAL);
        if (n <= 0) break;
        sent += static_cast<std::size_t>(n);
      }
      char byte = 0;
      if (script.isSilent)
        while (read(client, &byte, 1) > 0) continue;
      shutdown(client, SHUT_WR);
      close(client);
    }
  }

  static std::string requestOf(int client) {
    std::string head;
    for (char byte = 0; !head.ends_with("\r\n\r\n") && read(client, &byte, 1) == 1;) head += byte;
    return head;
  }

  std::vector<Script> m_scripts;
  std::vector<std::string> m_requests;
  int m_socket = -1;
  int m_port = 0;
  std::thread m_thread;
};

}  // namespace lumen::convert
