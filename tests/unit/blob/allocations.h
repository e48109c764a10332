// SPDX-License-Identifier: Apache-2.0
// A count of what a program of tests allocates.
#pragma once

#include <cstddef>

namespace lumen::blob::test {

/// Number of calls of operator new so far, of all threads.
std::size_t countAllocations();

}  // namespace lumen::blob::test
