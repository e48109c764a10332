// SPDX-License-Identifier: Apache-2.0
// Calls of code that untrusted bytes may crash, in a process of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "converters/base/progress.h"

namespace lumen::convert {

/// How a call in a process of its own ended.
enum class IsolatedEnd { Done, Refused, Crashed };

/// Calls `fill` with a buffer as large as `out` in a child process, and copies the buffer into
/// `out` if `fill` returned true. The child is killed beyond `memory` bytes more than this process
/// has, and beyond `seconds` of processor time. `fill` must neither print nor touch files or
/// threads. Throws Error(Failed) if no child can be started; Error(Cancelled).
IsolatedEnd callIsolated(std::span<std::byte> out, std::size_t memory, unsigned seconds,
                         const std::function<bool(std::span<std::byte>)>& fill,
                         const Progress& progress);

}  // namespace lumen::convert
