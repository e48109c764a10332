// SPDX-License-Identifier: Apache-2.0
// Two functions at once: see parallel_for.h.
#pragma once

#include <tbb/parallel_for.h>

namespace tbb {

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  parallel_for(0, 2, [&](int i) { i == 0 ? first() : second(); });
}

}  // namespace tbb
