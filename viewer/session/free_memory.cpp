// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/free_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace lumen::viewer {

void returnLargeBlocks() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 20;  // bytes; smaller ones are faster out of an arena
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

void returnFreeMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace lumen::viewer
