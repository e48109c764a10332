// SPDX-License-Identifier: Apache-2.0
// See parallel_for.h.
#pragma once

namespace tbb {

/// One index at a time.
struct simple_partitioner {};

}  // namespace tbb
