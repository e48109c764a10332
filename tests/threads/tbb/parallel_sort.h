// SPDX-License-Identifier: Apache-2.0
// Stands in for oneTBB's under ThreadSanitizer: see parallel_for.h. Sorts on one thread.
#pragma once

#include <algorithm>

namespace tbb {

template <class Iterator, class Less>
void parallel_sort(Iterator begin, Iterator end, Less less) {
  std::sort(begin, end, less);
}

template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  std::sort(begin, end);
}

}  // namespace tbb
