// SPDX-License-Identifier: Apache-2.0
// Work that ends when the client is gone.
#pragma once

#include <functional>

#include "converters/base/progress.h"

namespace lumen::viewer {

/// Calls `work` with a progress that is cancelled when the client at that port of this machine
/// closes the connection, because nobody waits for the answer. Throws as `work`.
void whileConnected(int remotePort, const std::function<void(Progress&)>& work);

}  // namespace lumen::viewer
