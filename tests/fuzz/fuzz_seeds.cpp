// SPDX-License-Identifier: Apache-2.0
// lumen's own seeds files.
#include "fuzz/fuzz_support.h"
#include "fuzz/seeds_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::readSeedsOf(data, size);
  return 0;
}
