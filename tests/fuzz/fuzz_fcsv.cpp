// SPDX-License-Identifier: Apache-2.0
// 3D Slicer's comma-separated fiducials: what follows the sign by which they are known.
#include <string>

#include "fuzz/fuzz_support.h"
#include "fuzz/seeds_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text = "#";
  text.append(reinterpret_cast<const char*>(data), size);
  lumen::fuzz::readSeedsOf(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return 0;
}
