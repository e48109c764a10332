// SPDX-License-Identifier: Apache-2.0
// Declared in case_encoding.h.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "formats/case/case_as_view.h"
#include "formats/case/case_encoding.h"
#include "formats/case/chunk_codec.h"
#include "formats/case/metadata_json.h"
#include "formats/case/motion.h"
#include "formats/container/bytes.h"
#include "formats/view/case_chunks.h"

namespace lumen::formats {
namespace {

using Bytes = std::vector<std::byte>;

// Adding zero turns a negative zero into zero and changes nothing else.
float canonical(float value) {
  return value + 0.0f;
}
double canonical(double value) {
  return value + 0.0;
}

Bytes packed(const std::vector<float>& values) {
  Bytes bytes(values.size() * 4);
  for (std::size_t i = 0; i < values.size(); ++i)
    storeLittle(bytes.data() + 4 * i, canonical(values[i]));
  return bytes;
}

Bytes packed(const std::vector<Vec3f>& values) {
  Bytes bytes(values.size() * 12);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::byte* to = bytes.data() + 12 * i;
    storeLittle(to, canonical(values[i].x));
    storeLittle(to + 4, canonical(values[i].y));
    storeLittle(to + 8, canonical(values[i].z));
  }
  return bytes;
}

template <class Integer>
Bytes packedIntegers(const std::vector<Integer>& values) {
  Bytes bytes(values.size() * sizeof(Integer));
  for (std::size_t i = 0; i < values.size(); ++i)
    storeLittle(bytes.data() + sizeof(Integer) * i, values[i]);
  return bytes;
}

Bytes textBytes(std::string_view text) {
  Bytes bytes(text.size());
  std::transform(text.begin(), text.end(), bytes.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

Bytes kernelRecord(const BlobbyModels& models) {
  Bytes bytes;
  appendLittle(bytes, static_cast<std::uint8_t>(models.kernel));
  bytes.resize(8);
  appendLittle(bytes, canonical(models.kernelParameter));
  appendLittle(bytes, canonical(models.isoLevel));
  return bytes;
}

Bytes packedPairs(const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  Bytes bytes(pairs.size() * 8);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    storeLittle(bytes.data() + 8 * i, pairs[i][0]);
    storeLittle(bytes.data() + 8 * i + 4, pairs[i][1]);
  }
  return bytes;
}

Bytes packedArray(const NodeArray& array) {
  if (const auto* values = std::get_if<0>(&array.values)) return packed(*values);
  if (const auto* values = std::get_if<1>(&array.values)) return packedIntegers(*values);
  return packedIntegers(std::get<2>(array.values));
}

Bytes packedMotion(const Motion& motion) {
  Bytes bytes;
  bytes.reserve(kMotionHeadSize + 8 * motion.time.size() + 4 * motion.node.size() +
                kPoseSize * motion.pose.size());
  appendLittle(bytes, static_cast<std::uint32_t>(motion.time.size()));
  appendLittle(bytes, static_cast<std::uint32_t>(motion.node.size()));
  appendLittle(bytes, canonical(motion.period));
  for (const double time : motion.time) appendLittle(bytes, canonical(time));
  for (const std::uint32_t node : motion.node) appendLittle(bytes, node);
  for (const Pose& pose : motion.pose) {
    for (const float value : {pose.centre.x, pose.centre.y, pose.centre.z})
      appendLittle(bytes, canonical(value));
    for (const float value : pose.rotation) appendLittle(bytes, canonical(value));
    appendLittle(bytes, canonical(pose.factor));
  }
  return bytes;
}

class ChunkWriter {
public:
  explicit ChunkWriter(const EncodeOptions& options) : m_options(options) {}

  void add(ChunkType type, Bytes bytes) {
    ChunkSource source;
    source.type = type;
    source.critical = kChunkRules[chunkRuleIndex(type)].critical;
    source.rawSize = bytes.size();
    source.bytes = std::move(bytes);
    if (m_options.compress)
      if (auto stored = compressZstd(source.bytes)) {
        source.bytes = *std::move(stored);
        source.encoding = static_cast<std::uint8_t>(ChunkEncoding::Zstd);
      }
    m_chunks.push_back(std::move(source));
  }

  void addPositions(const std::vector<Vec3f>& points,
                    const std::optional<QuantisedPoints>& quantised) {
    if (!quantised) return add(chunk::kPointPosition, packed(points));
    ChunkSource source;
    source.type = chunk::kPointPosition;
    source.rawSize = points.size() * 12;
    if (source.rawSize > kMaxExpansion * quantised->encoded.size())
      return add(chunk::kPointPosition, packed(quantised->decoded()));
    source.encoding = static_cast<std::uint8_t>(ChunkEncoding::Draco);
    source.bytes = quantised->encoded;
    m_chunks.push_back(std::move(source));
  }

  void addOther(const OtherChunk& other) {
    ChunkSource source;
    const char name[5] = {other.type[0], other.type[1], other.type[2], other.type[3], '\0'};
    source.type = chunkType(name);
    source.version = other.version;
    source.independent = other.independent;
    source.encoding = other.encoding;
    source.rawSize = other.rawSize;
    source.bytes = other.bytes;
    m_chunks.push_back(std::move(source));
  }

  [[nodiscard]] Bytes file(FormatVersion version) const {
    return writeContainer(m_chunks, version);
  }

private:
  EncodeOptions m_options;
  std::vector<ChunkSource> m_chunks;
};

void addModels(ChunkWriter& chunks, const BlobbyModels& models) {
  chunks.add(chunk::kModelKernel, kernelRecord(models));
  chunks.add(chunk::kModelOffset, packedIntegers(models.offset));
  chunks.add(chunk::kModelCentre, packed(models.centre));
  chunks.add(chunk::kModelWidth, packed(models.width));
}

void addTree(ChunkWriter& chunks, const CenterlineTree& tree) {
  chunks.add(chunk::kNodeCentre, packed(tree.centre));
  chunks.add(chunk::kNodeDirection, packed(tree.direction));
  chunks.add(chunk::kNodeRadius, packed(tree.radius));
  chunks.add(chunk::kNodeHeight, packed(tree.height));
  chunks.add(chunk::kNodeParent, packedIntegers(tree.parent));
  chunks.add(chunk::kNodeBranch, packedIntegers(tree.branch));
  if (!tree.inlierRate.empty()) chunks.add(chunk::kNodeInlierRate, packed(tree.inlierRate));
  chunks.add(chunk::kBranchRecords, branchRecords(tree.branches));
  chunks.add(chunk::kBranchLabels, textBytes(joinedLabels(tree.branches)));
  if (!tree.links.empty()) chunks.add(chunk::kLinks, packedPairs(tree.links));
}

}  // namespace

std::vector<std::byte> encodeBinary(const Case& value, const EncodeOptions& options) {
  Metadata metadata = value.metadata;
  std::optional<QuantisedPoints> quantised;
  if (value.points && options.pointBits != 0)
    quantised = quantise(value.points->position, options.pointBits);
  if (quantised) metadata.pointQuantisation = quantised->quantisation;

  ChunkWriter chunks(options);
  chunks.add(chunk::kMetadata, textBytes(metadataJson(metadata, value.nodeArrays)));
  addTree(chunks, value.tree);
  if (value.points) {
    chunks.add(chunk::kPointOffset, packedIntegers(value.points->offset));
    chunks.addPositions(value.points->position, quantised);
  }
  if (value.models) addModels(chunks, *value.models);
  for (const NodeArray& array : value.nodeArrays) chunks.add(chunk::kNodeArray, packedArray(array));
  if (value.motion) chunks.add(chunk::kMotion, packedMotion(*value.motion));
  for (const OtherChunk& other : value.otherChunks) chunks.addOther(other);
  return chunks.file(versionOf(value));
}

void quantisePoints(Case& value, int bits) {
  if (bits < 1 || bits > 30) throw std::invalid_argument("point bits are 1 to 30");
  if (!value.points) return;
  const auto quantised = quantise(value.points->position, bits);
  if (!quantised) return;
  value.points->position = quantised->decoded();
  value.metadata.pointQuantisation = quantised->quantisation;
}

}  // namespace lumen::formats
