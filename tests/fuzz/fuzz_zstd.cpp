// SPDX-License-Identifier: Apache-2.0
// A zstd chunk with a raw size of its own: decoded to that size, or refused; and what is compressed
// here is given back.
#include <algorithm>

#include "formats/case/chunk_codec.h"
#include "fuzz/fuzz_support.h"

using namespace lumen::formats;
using lumen::fuzz::expect;

namespace {

Chunk chunkOf(std::span<const std::byte> stored, std::uint64_t rawSize) {
  Chunk chunk;
  chunk.type = chunkType("NRAD");
  chunk.encoding = static_cast<std::uint8_t>(ChunkEncoding::Zstd);
  chunk.rawSize = rawSize;
  chunk.stored = stored;
  return chunk;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const auto bytes = lumen::fuzz::bytesOf(data, size);
  const auto rawSize = loadLittle<std::uint32_t>(bytes.data());
  const auto stored = bytes.subspan(4);
  IssueList issues(1);
  if (rawSize <= kMaxExpansion * stored.size()) {
    const auto raw = decodeChunk(chunkOf(stored, rawSize), issues);
    expect(raw ? raw->size() == rawSize : issues.failed(), "a chunk decodes, or has an issue");
  }
  if (const auto compressed = compressZstd(bytes)) {
    IssueList none(1);
    const auto raw = decodeChunk(chunkOf(*compressed, bytes.size()), none);
    expect(raw && std::equal(raw->begin(), raw->end(), bytes.begin(), bytes.end()),
           "what was compressed is given back");
  }
  return 0;
}
