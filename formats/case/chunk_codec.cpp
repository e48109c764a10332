// SPDX-License-Identifier: Apache-2.0
#include "formats/case/chunk_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <zstd.h>

#include "formats/container/bytes.h"
#include "formats/view/case_chunks.h"

namespace lumen::formats {

namespace {

constexpr std::size_t kPointSize = 12;

// Checks the head of the bitstream, which determines how much memory the library allocates. Only
// one attribute of three floats passes, so the memory is what the stated raw size allows.
bool hasLegalHead(std::span<const std::byte> bytes, std::uint64_t points) {
  constexpr std::array<char, 5> kName = {'D', 'R', 'A', 'C', 'O'};
  ByteCursor cursor(bytes);
  for (const char c : kName)
    if (cursor.read<std::uint8_t>() != static_cast<std::uint8_t>(c)) return false;
  const auto major = cursor.read<std::uint8_t>();
  cursor.read<std::uint8_t>();                          // minor version
  const auto geometry = cursor.read<std::uint8_t>();    // 0: point cloud
  const auto method = cursor.read<std::uint8_t>();      // 0: sequential
  const auto flags = cursor.read<std::uint16_t>();      // 0: no metadata
  const auto count = cursor.read<std::uint32_t>();      // points
  const auto decoders = cursor.read<std::uint8_t>();    // groups of attributes
  const auto attributes = cursor.read<std::uint8_t>();  // in the group; a varint below 128
  const auto semantic = cursor.read<std::uint8_t>();    // 0: position
  const auto type = cursor.read<std::uint8_t>();        // 9: f32
  const auto components = cursor.read<std::uint8_t>();
  const auto normalised = cursor.read<std::uint8_t>();
  const auto identifier = cursor.read<std::uint8_t>();  // a varint below 128
  const auto transform = cursor.read<std::uint8_t>();   // 2: quantisation
  return !cursor.failed() && major == 2 && geometry == 0 && method == 0 && flags == 0 &&
         count == points && decoders == 1 && attributes == 1 && semantic == 0 && type == 9 &&
         components == 3 && normalised == 0 && identifier == 0 && transform == 2;
}

draco::GeometryAttribute positionAttribute() {
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false,
                 static_cast<std::int64_t>(kPointSize), 0);
  return attribute;
}

}  // namespace

std::optional<QuantisationBox> quantisationBox(std::span<const Vec3f> points) {
  if (points.empty()) return QuantisationBox{};
  Vec3f low = points[0], high = points[0];
  for (const Vec3f& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const float range = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!std::isfinite(range)) return std::nullopt;
  return QuantisationBox{low, range > 0 ? range : 1.0f};
}

std::vector<std::byte> encodeDraco(std::span<const Vec3f> points, const QuantisationBox& box,
                                   int bits) {
  draco::PointCloud cloud;
  const auto count = static_cast<std::uint32_t>(points.size());
  cloud.set_num_points(count);
  const int id = cloud.AddAttribute(positionAttribute(), true, count);
  draco::PointAttribute& positions = *cloud.attribute(id);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::array<float, 3> p = {points[i].x, points[i].y, points[i].z};
    positions.SetAttributeValue(draco::AttributeValueIndex(i), p.data());
  }
  draco::ExpertEncoder encoder(cloud);
  encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(3, 3);
  // the library counts symbols in a table of up to 2^(bits + 1) entries, however few points there
  // are; beyond 24 bits, the size of an f32's significand, the table gains nothing
  encoder.SetUseBuiltInAttributeCompression(bits <= 24);
  const std::array<float, 3> origin = {box.origin.x, box.origin.y, box.origin.z};
  encoder.SetAttributeExplicitQuantization(id, bits, 3, origin.data(), box.range);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return {};
  const auto* data = reinterpret_cast<const std::byte*>(buffer.data());
  return {data, data + buffer.size()};
}

std::optional<std::vector<std::byte>> decodeDraco(std::span<const std::byte> bytes,
                                                  std::size_t rawSize) {
  const std::uint64_t count = rawSize / kPointSize;
  if (rawSize % kPointSize != 0 || !hasLegalHead(bytes, count)) return std::nullopt;
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
  if (!decoded.ok() || buffer.remaining_size() != 0) return std::nullopt;
  const draco::PointCloud& cloud = *decoded.value();
  const draco::PointAttribute* positions =
      cloud.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (positions == nullptr || cloud.num_points() != count) return std::nullopt;
  std::vector<std::byte> raw(rawSize);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 3> p{};
    positions->GetMappedValue(draco::PointIndex(i), p.data());
    for (std::size_t c = 0; c < 3; ++c) storeLittle(raw.data() + kPointSize * i + 4 * c, p[c]);
  }
  return raw;
}

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
