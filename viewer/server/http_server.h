// SPDX-License-Identifier: Apache-2.0
// An HTTP server on which a slow sender cannot hold a thread.
// after Eigen, which the macros of <resolv.h> break
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <httplib.h>

#include "converters/base/progress.h"

namespace lumen::viewer {

/// Each connection carries one request, all of which must arrive in time: 2 s, and 1 s more for
/// each MiB that has arrived. A connection that is later is closed. httplib bounds only the time
/// between two pieces of a request.
class HttpServer : public httplib::Server {
private:
  bool process_and_close_socket(socket_t socket) override;
};

// Work that ends when the client is gone.

/// Calls `work` with a progress that is cancelled when the client at that port of this machine
/// closes the connection, because nobody waits for the answer. Throws as `work`.
void whileConnected(int remotePort, const std::function<void(Progress&)>& work);

// The secret of the page.

/// 128 random bits of the operating system as 32 hexadecimal digits. Throws Error(Failed).
std::string randomToken();

/// True if two texts are equal. The time does not depend on the place where they differ.
bool sameSecret(std::string_view a, std::string_view b);

}  // namespace lumen::viewer
