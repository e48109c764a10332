// SPDX-License-Identifier: Apache-2.0
// The page and the session over HTTP, on this machine only (viewer/README.md, "Requests").
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "viewer/routes/html_page.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

struct ServerOptions {
  int port = 0;  ///< 0: any that is free
  /// Most bytes of a dropped file; larger volumes are opened by name.
  std::uint64_t mostFile = std::uint64_t{4} << 30;
};

/// Answers only requests for the address that it returns, which nobody can guess: the socket is on
/// the loopback interface, the path has 128 random bits, and `Host` and `Origin` must name the
/// address, so neither a page of another origin nor a name that is rebound to 127.0.0.1 gets an
/// answer.
class Server {
public:
  /// Listens. Throws Error(Failed) if it cannot. The session must outlive it.
  Server(Session& session, PageFiles page, const ServerOptions& options = {});
  /// Ends all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "http://127.0.0.1:40123/0123456789abcdef0123456789abcdef/".
  [[nodiscard]] std::string address() const;
  void stop();

private:
  class Requests;
  std::unique_ptr<Requests> m_requests;
};

}  // namespace lumen::viewer
