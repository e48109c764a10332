// SPDX-License-Identifier: Apache-2.0
#include "formats/case/chunk_codec.h"

#include <zstd.h>

#include "formats/case/draco_points.h"
#include "formats/container/bytes.h"
#include "formats/view/case_chunks.h"

namespace lumen::formats {
namespace {

constexpr int kLevel = 9;
constexpr std::uint32_t kFrameMagic = 0xfd2fb528u;

// Whether one frame fills the bytes: the library itself accepts several, and frames of old formats.
bool isOneFrame(std::span<const std::byte> bytes) {
  return bytes.size() >= 4 && loadLittle<std::uint32_t>(bytes.data()) == kFrameMagic &&
         ZSTD_findFrameCompressedSize(bytes.data(), bytes.size()) == bytes.size();
}

std::optional<std::vector<std::byte>> decompressZstd(std::span<const std::byte> bytes,
                                                     std::size_t rawSize) {
  if (!isOneFrame(bytes)) return std::nullopt;
  std::vector<std::byte> raw(rawSize);
  if (ZSTD_decompress(raw.data(), raw.size(), bytes.data(), bytes.size()) != rawSize)
    return std::nullopt;
  return raw;
}

Issue codecIssue(ErrorCode code, const Chunk& chunk, const std::string& what) {
  const std::string name = chunkName(chunk.type);
  return {code, chunk.offset, "chunk " + name + " " + what, {{"chunk", name}}};
}

}  // namespace

std::optional<std::vector<std::byte>> compressZstd(std::span<const std::byte> bytes) {
  std::vector<std::byte> stored(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(stored.data(), stored.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size >= bytes.size() || bytes.size() > kMaxExpansion * size)
    return std::nullopt;
  stored.resize(size);
  return stored;
}

std::optional<QuantisedPoints> quantise(std::span<const Vec3f> points, int bits) {
  const auto box = quantisationBox(points);
  if (points.empty() || !box) return std::nullopt;
  const double step = double{box->range} / static_cast<double>((std::uint64_t{1} << bits) - 1);
  return QuantisedPoints{encodeDraco(points, *box, bits), {bits, step}, points.size()};
}

std::vector<Vec3f> QuantisedPoints::decoded() const {
  const auto raw = decodeDraco(encoded, count * 12);
  std::vector<Vec3f> points(raw ? count : 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::byte* from = raw->data() + 12 * i;
    points[i] = {loadLittle<float>(from), loadLittle<float>(from + 4), loadLittle<float>(from + 8)};
  }
  return points;
}

std::optional<std::vector<std::byte>> decodeChunk(const Chunk& chunk, IssueList& issues) {
  std::optional<std::vector<std::byte>> raw;
  const auto rawSize = static_cast<std::size_t>(chunk.rawSize);
  const auto encoding = static_cast<ChunkEncoding>(chunk.encoding);
  if (encoding == ChunkEncoding::Zstd) {
    raw = decompressZstd(chunk.stored, rawSize);
  } else if (encoding == ChunkEncoding::Draco && chunk.type == chunk::kPointPosition) {
    raw = decodeDraco(chunk.stored, rawSize);
  } else {
    Issue issue = codecIssue(ErrorCode::ChunkEncoding, chunk,
                             "has encoding " + std::to_string(chunk.encoding) +
                                 ", which a chunk of its type cannot have");
    issue.arguments.push_back({"found", std::to_string(chunk.encoding)});
    issues.add(std::move(issue));
    return std::nullopt;
  }
  if (!raw)
    issues.add(codecIssue(ErrorCode::ChunkDecode, chunk,
                          "does not decode to its " + std::to_string(rawSize) + " raw bytes"));
  return raw;
}

}  // namespace lumen::formats
