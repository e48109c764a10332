// SPDX-License-Identifier: Apache-2.0
#include "unit/formats/allocation_meter.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::atomic<std::size_t> live{0}, peak{0}, start{0};

}  // namespace

void* operator new(std::size_t size) {
  void* block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  const std::size_t now = live += malloc_usable_size(block);
  if (now > peak) peak = now;
  return block;
}

void operator delete(void* block) noexcept {
  live -= malloc_usable_size(block);
  std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
  live -= malloc_usable_size(block);
  std::free(block);
}

namespace lumen::formats::test {

void startMeter() {
  peak = start = live.load();
}
std::size_t peakBytes() {
  return peak - start;
}

}  // namespace lumen::formats::test
