// SPDX-License-Identifier: Apache-2.0
// Runs code that untrusted bytes may bring down, where it brings down nothing else.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "converters/base/progress.h"

namespace lumen::convert {

/// How a call in a process of its own ended.
enum class IsolatedEnd { Done, Refused, Crashed };

/// Calls `fill` with a buffer as large as `out` in a child process, whose memory beyond `memory`
/// bytes more than this process has, and whose time beyond `seconds` of processor, end it; copies
/// the buffer into `out` if `fill` gave true. `fill` must neither print nor touch files or threads.
/// Throws Error(Failed) if there can be no child; Error(Cancelled).
IsolatedEnd callIsolated(std::span<std::byte> out, std::size_t memory, unsigned seconds,
                         const std::function<bool(std::span<std::byte>)>& fill,
                         const Progress& progress);

}  // namespace lumen::convert
