// SPDX-License-Identifier: Apache-2.0
// An HTTP server on which a slow sender cannot hold a thread.
#pragma once

// after Eigen, which the macros of <resolv.h> break
#include <Eigen/Core>
#include <httplib.h>

namespace lumen::viewer {

/// Each connection carries one request, all of which must arrive in time: 2 s, and 1 s more for
/// each MiB that has arrived. A connection that is later is closed. httplib bounds only the time
/// between two pieces of a request.
class HttpServer : public httplib::Server {
private:
  bool process_and_close_socket(socket_t socket) override;
};

}  // namespace lumen::viewer
