// SPDX-License-Identifier: Apache-2.0
// The place of a value in a binary file, from its JSON pointer.
#include <algorithm>
#include <charconv>
#include <string_view>

#include "formats/container/bytes.h"
#include "formats/view/model_rules.h"

namespace lumen::formats {
namespace {

struct PlacedArray {
  std::string_view pointer;
  ChunkType type;
  std::uint32_t offset;  ///< position of a field in a record
};

// Places of arrays; longer pointers come before their own prefixes.
constexpr auto kPlaces = std::to_array<PlacedArray>({
    {"/metadata", chunk::kMetadata, 0},
    {"/tree/centre", chunk::kNodeCentre, 0},
    {"/tree/direction", chunk::kNodeDirection, 0},
    {"/tree/radius", chunk::kNodeRadius, 0},
    {"/tree/height", chunk::kNodeHeight, 0},
    {"/tree/parent", chunk::kNodeParent, 0},
    {"/tree/branches", chunk::kBranchRecords, 0},
    {"/tree/branch", chunk::kNodeBranch, 0},
    {"/tree/inlierRate", chunk::kNodeInlierRate, 0},
    {"/tree/links", chunk::kLinks, 0},
    {"/points/offset", chunk::kPointOffset, 0},
    {"/points/position", chunk::kPointPosition, 0},
    {"/models/kernelParameter", chunk::kModelKernel, 8},
    {"/models/kernel", chunk::kModelKernel, 0},
    {"/models/isoLevel", chunk::kModelKernel, 16},
    {"/models/offset", chunk::kModelOffset, 0},
    {"/models/centre", chunk::kModelCentre, 0},
    {"/models/width", chunk::kModelWidth, 0},
    {"/motion", chunk::kMotion, 0},
});

struct PlacedField {
  std::string_view name;
  std::uint32_t offset;
};
constexpr auto kBranchFields = std::to_array<PlacedField>({{"firstNode", 0},
                                                           {"nodeCount", 4},
                                                           {"parentNode", 8},
                                                           {"kind", 18},
                                                           {"stopReason", 19},
                                                           {"meanInlierRate", 20}});

// Removes the first index from `rest` (12 from "/12/1") and returns it; nothing if there is none.
std::optional<std::uint64_t> takeIndex(std::string_view& rest) {
  if (rest.size() < 2 || rest.front() != '/') return std::nullopt;
  std::uint64_t index = 0;
  const auto parsed = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
  if (parsed.ec != std::errc{}) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(parsed.ptr - rest.data()));
  return index;
}

// The offset of a field of a branch's record; its label is in a chunk of its own.
std::uint64_t branchFieldOffset(const Chunk& records, std::uint64_t recordAt, std::string_view rest,
                                const CaseChunks& chunks) {
  if (rest == "/label" && records.stored.size() >= recordAt + kBranchRecordSize) {
    const Chunk* labels = chunks.find(chunk::kBranchLabels);
    if (labels == nullptr || labels->encoding != 0) return records.offset + recordAt;
    return labels->offset + loadLittle<std::uint32_t>(records.stored.data() + recordAt + 12);
  }
  for (const PlacedField& field : kBranchFields)
    if (!rest.empty() && rest.substr(1) == field.name)
      return records.offset + recordAt + field.offset;
  return records.offset + recordAt;
}

struct PoseField {
  std::string_view key;
  std::uint64_t offset;  ///< in a pose
};
constexpr auto kPoseFields =
    std::to_array<PoseField>({{"/centre", 0}, {"/rotation", 12}, {"/factor", 28}});

// The offset of a value of the motion; `rest` is its pointer behind "/motion".
std::uint64_t motionOffset(const Chunk& chunk, std::string_view rest) {
  if (chunk.encoding != 0 || chunk.stored.size() < kMotionHeadSize) return chunk.offset;
  const std::uint64_t times = loadLittle<std::uint32_t>(chunk.stored.data());
  const std::uint64_t nodes = loadLittle<std::uint32_t>(chunk.stored.data() + 4);
  const auto indexAfter = [&rest](std::string_view key) {
    rest.remove_prefix(key.size());
    return takeIndex(rest);
  };
  if (rest.starts_with("/period")) return chunk.offset + 8;
  if (rest.starts_with("/time")) {
    const auto index = indexAfter("/time");
    return chunk.offset + (index ? kMotionHeadSize + 8 * *index : 0);
  }
  const std::uint64_t nodesAt = chunk.offset + kMotionHeadSize + 8 * times;
  if (rest.starts_with("/node")) return nodesAt + 4 * indexAfter("/node").value_or(0);
  for (const PoseField& field : kPoseFields) {
    if (!rest.starts_with(field.key)) continue;
    const std::uint64_t time = indexAfter(field.key).value_or(0);
    const std::uint64_t node = takeIndex(rest).value_or(0);
    const std::uint64_t component = takeIndex(rest).value_or(0);
    return nodesAt + 4 * nodes + kPoseSize * (time * nodes + node) + field.offset + 4 * component;
  }
  return chunk.offset;
}

}  // namespace

std::optional<std::uint64_t> findByteOffset(const std::string& pointer, const CaseChunks& chunks) {
  const auto place = std::find_if(kPlaces.begin(), kPlaces.end(), [&](const PlacedArray& p) {
    return pointer.starts_with(p.pointer);
  });
  if (place == kPlaces.end()) return std::nullopt;
  const Chunk* chunk = chunks.find(place->type);
  if (chunk == nullptr) return std::nullopt;
  if (chunk->encoding != 0 || place->type == chunk::kMetadata) return chunk->offset;
  std::string_view rest = std::string_view(pointer).substr(place->pointer.size());
  if (place->type == chunk::kMotion) return motionOffset(*chunk, rest);
  const std::uint64_t stride = kChunkRules[chunkRuleIndex(place->type)].stride;
  const auto index = takeIndex(rest);
  if (!index) return chunk->offset + place->offset;
  if (place->type == chunk::kBranchRecords)
    return branchFieldOffset(*chunk, *index * stride, rest, chunks);
  const std::uint64_t component = takeIndex(rest).value_or(0);
  return chunk->offset + *index * stride + 4 * component;
}

}  // namespace lumen::formats
