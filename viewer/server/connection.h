// SPDX-License-Identifier: Apache-2.0
// Whether whoever asked is still there.
#pragma once

#include <functional>

#include "converters/base/progress.h"

namespace lumen::viewer {

/// Calls `work` with a progress that is cancelled when the connection from that port of this machine
/// is closed by its other end: nobody waits for the answer. Gives on what `work` throws.
void whileConnected(int remotePort, const std::function<void(Progress&)>& work);

}  // namespace lumen::viewer
