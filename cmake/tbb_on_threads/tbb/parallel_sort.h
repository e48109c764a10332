// SPDX-License-Identifier: Apache-2.0
// Sorts of TBB that the project uses, on one thread: see parallel_for.h.
#pragma once

#include <algorithm>

namespace tbb {

template <class Iterator>
void parallel_sort(Iterator first, Iterator last) {
  std::sort(first, last);
}

template <class Iterator, class Compare>
void parallel_sort(Iterator first, Iterator last, const Compare& compare) {
  std::sort(first, last, compare);
}

}  // namespace tbb
