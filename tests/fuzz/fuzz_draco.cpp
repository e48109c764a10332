// SPDX-License-Identifier: Apache-2.0
// A Draco chunk with a raw size of its own: decoded to that size, or refused.
#include "formats/case/draco_points.h"
#include "fuzz/fuzz_support.h"

using namespace lumen::formats;

// Four bytes of raw size, then the chunk. Sizes beyond the legal expansion are refused before a
// chunk is decoded.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const auto bytes = lumen::fuzz::bytesOf(data, size);
  const auto rawSize = loadLittle<std::uint32_t>(bytes.data());
  const auto stored = bytes.subspan(4);
  if (rawSize > kMaxExpansion * stored.size()) return 0;
  const auto raw = decodeDraco(stored, rawSize);
  lumen::fuzz::expect(!raw || raw->size() == rawSize, "a chunk decodes to its raw size");
  return 0;
}
