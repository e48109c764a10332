// SPDX-License-Identifier: Apache-2.0
// The page and the session over HTTP, on this machine only (viewer/README.md, "Requests").
#pragma once

#include <memory>
#include <string>

#include "viewer/server/page_files.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

/// Answers only what comes to the address that it gives, which nobody can guess: the socket is of
/// the loopback interface, the path has 128 random bits, and `Host` and `Origin` must name the
/// address, so that neither a page of another origin nor a name that is rebound to 127.0.0.1 gets
/// anything.
class Server {
public:
  /// Listens on `port`, or on one that is free if it is 0. Throws Error(Failed) if it cannot. The
  /// session must outlive it.
  Server(Session& session, PageFiles page, int port);
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
