// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "formats/case/case_file.h"
#include "formats/case/chunks.h"
#include "formats/case/metadata_json.h"
#include "formats/container/bytes.h"

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

Bytes branchRecords(const std::vector<Branch>& branches) {
  Bytes bytes;
  bytes.reserve(branches.size() * kBranchRecordSize);
  std::uint32_t labelOffset = 0;
  for (const Branch& branch : branches) {
    const auto labelSize = static_cast<std::uint16_t>(branch.label.size());
    appendLittle(bytes, branch.firstNode);
    appendLittle(bytes, branch.nodeCount);
    appendLittle(bytes, branch.parentNode);
    appendLittle(bytes, labelOffset);
    appendLittle(bytes, labelSize);
    appendLittle(bytes, static_cast<std::uint8_t>(branch.kind));
    appendLittle(bytes, static_cast<std::uint8_t>(branch.stopReason));
    appendLittle(bytes, canonical(branch.meanInlierRate.value_or(kNoRate)));
    labelOffset += labelSize;
  }
  return bytes;
}

std::string joinedLabels(const std::vector<Branch>& branches) {
  std::string labels;
  for (const Branch& branch : branches) labels += branch.label;
  return labels;
}

Bytes kernelRecord(const BlobbyModels& models) {
  Bytes bytes;
  appendLittle(bytes, static_cast<std::uint8_t>(models.kernel));
  bytes.resize(8);
  appendLittle(bytes, canonical(models.kernelParameter));
  appendLittle(bytes, canonical(models.isoLevel));
  return bytes;
}

class CaseChunks {
public:
  void add(ChunkType type, Bytes bytes) {
    const auto rule = std::find_if(kChunkRules.begin(), kChunkRules.end(),
                                   [type](const ChunkRule& r) { return r.type == type; });
    m_chunks.push_back({type, 1, rule->critical, std::move(bytes)});
  }
  [[nodiscard]] Bytes file() const { return writeContainer(m_chunks); }

private:
  std::vector<ChunkSource> m_chunks;
};

}  // namespace

std::vector<std::byte> encodeBinary(const Case& value) {
  const CenterlineTree& tree = value.tree;
  CaseChunks chunks;
  chunks.add(chunk::kMetadata, textBytes(metadataJson(value.metadata)));
  chunks.add(chunk::kNodeCentre, packed(tree.centre));
  chunks.add(chunk::kNodeDirection, packed(tree.direction));
  chunks.add(chunk::kNodeRadius, packed(tree.radius));
  chunks.add(chunk::kNodeHeight, packed(tree.height));
  chunks.add(chunk::kNodeParent, packedIntegers(tree.parent));
  chunks.add(chunk::kNodeBranch, packedIntegers(tree.branch));
  if (!tree.inlierRate.empty()) chunks.add(chunk::kNodeInlierRate, packed(tree.inlierRate));
  chunks.add(chunk::kBranchRecords, branchRecords(tree.branches));
  chunks.add(chunk::kBranchLabels, textBytes(joinedLabels(tree.branches)));
  if (value.points) {
    chunks.add(chunk::kPointOffset, packedIntegers(value.points->offset));
    chunks.add(chunk::kPointPosition, packed(value.points->position));
  }
  if (value.models) {
    chunks.add(chunk::kModelKernel, kernelRecord(*value.models));
    chunks.add(chunk::kModelOffset, packedIntegers(value.models->offset));
    chunks.add(chunk::kModelCentre, packed(value.models->centre));
    chunks.add(chunk::kModelWidth, packed(value.models->width));
  }
  return chunks.file();
}

}  // namespace lumen::formats
