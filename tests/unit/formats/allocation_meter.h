// SPDX-License-Identifier: Apache-2.0
// Counts what this program allocates with new.
#pragma once

#include <cstddef>

namespace lumen::formats::test {

/// From now on, peakBytes() counts what is allocated beyond what is now.
void startMeter();
/// The most bytes that were allocated at one time since startMeter().
std::size_t peakBytes();

}  // namespace lumen::formats::test
