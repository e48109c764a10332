// SPDX-License-Identifier: Apache-2.0
// 3D Slicer Markups: what stands between the braces of a file that has the key `markups`.
#include <string>

#include "fuzz/fuzz_support.h"
#include "fuzz/seeds_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text = "{\"markups\":[";
  text.append(reinterpret_cast<const char*>(data), size);
  text += "]}";
  lumen::fuzz::readSeedsOf(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return 0;
}
