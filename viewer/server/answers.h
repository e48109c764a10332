// SPDX-License-Identifier: Apache-2.0
// Reading and answering of requests of any kind.
#pragma once

#include <cstdint>
#include <string>

#include "viewer/routes/routes.h"

// after Eigen, which the macros of <resolv.h> break
#include <httplib.h>

namespace lumen::viewer {

/// Headers of every answer. The page may run its own script and libblob, and talk to this server.
httplib::Headers safeHeaders();

/// Hands an answer over, uncompressed. httplib compresses an answer that it gets whole, which takes
/// seconds for the page's script and saves nothing on the loopback interface.
void handOver(PageAnswer answer, httplib::Response& response);

/// The body, of at most `most` bytes. Throws Error(Usage) for a longer one, a form in several parts,
/// and one that breaks off.
std::string bodyOf(const httplib::Request& request, const httplib::ContentReader& reader,
                   std::uint64_t most);

}  // namespace lumen::viewer
