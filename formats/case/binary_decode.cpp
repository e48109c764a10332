// SPDX-License-Identifier: Apache-2.0
// Declared in case_encoding.h.
#include <algorithm>
#include <deque>
#include <optional>

#include "formats/case/case_encoding.h"
#include "formats/case/chunk_codec.h"
#include "formats/case/metadata_json.h"
#include "formats/case/motion.h"
#include "formats/case/validate.h"
#include "formats/container/bytes.h"
#include "formats/view/limits.h"
#include "formats/view/model_rules.h"

namespace lumen::formats {
namespace {

template <class T>
std::vector<T> copied(std::span<const T> values) {
  return {values.begin(), values.end()};
}

std::vector<Vec3f> copied(std::span<const Float3> values) {
  std::vector<Vec3f> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = {values[i][0], values[i][1], values[i][2]};
  return result;
}

// The decoded bytes of chunks; owns those that are not in the file itself.
class DecodedChunks {
public:
  DecodedChunks(CaseChunks& chunks, IssueList& issues) : m_issues(issues) {
    for (auto& chunk : chunks.byRule)
      if (chunk) decode(*chunk);
    for (Chunk& chunk : chunks.nodeArrays) decode(chunk);
  }

private:
  void decode(Chunk& chunk) {
    if (chunk.encoding == static_cast<std::uint8_t>(ChunkEncoding::Raw)) return;
    if (auto raw = decodeChunk(chunk, m_issues)) {
      m_buffers.push_back(*std::move(raw));
      chunk.stored = m_buffers.back();
    }
  }

  IssueList& m_issues;
  std::deque<std::vector<std::byte>> m_buffers;
};

CenterlineTree treeOf(const CaseView& view) {
  CenterlineTree tree;
  tree.centre = copied(view.nodeCentre);
  tree.direction = copied(view.nodeDirection);
  tree.radius = copied(view.nodeRadius);
  tree.height = copied(view.nodeHeight);
  tree.parent = copied(view.nodeParent);
  tree.branch = copied(view.nodeBranch);
  tree.inlierRate = copied(view.nodeInlierRate);
  tree.links = copied(view.links);
  tree.branches.reserve(view.branchCount());
  for (std::size_t b = 0; b < view.branchCount(); ++b) {
    const BranchView branch = view.branch(b);
    std::optional<float> rate;
    if (branch.meanInlierRate != kNoRate) rate = branch.meanInlierRate;
    tree.branches.push_back({std::string(view.label(branch)), static_cast<BranchKind>(branch.kind),
                             branch.parentNode, branch.firstNode, branch.nodeCount,
                             static_cast<StopReason>(branch.stopReason), rate});
  }
  return tree;
}

BlobbyModels modelsOf(const ModelView& view) {
  return {static_cast<Kernel>(view.kernel),
          view.kernelParameter,
          view.isoLevel,
          copied(view.offset),
          copied(view.centre),
          copied(view.width)};
}

OtherChunk otherChunk(const Chunk& chunk) {
  return {chunkName(chunk.type), chunk.version, chunk.independent,
          chunk.encoding,        chunk.rawSize, copied(chunk.stored)};
}

// The values of the arrays that the metadata describes, one chunk each.
void readNodeArrays(const CaseView& view, const CaseChunks& chunks, std::vector<NodeArray>& arrays,
                    IssueList& issues) {
  if (view.nodeArrays.size() != arrays.size())
    return issues.add({ErrorCode::ChunkMissing,
                       kHeaderSize,
                       "there are " + std::to_string(view.nodeArrays.size()) +
                           " chunks NARR, the metadata describe " + std::to_string(arrays.size()),
                       {{"chunk", "NARR"}}});
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const auto bytes = view.nodeArrays[i];
    const std::uint64_t expected =
        std::uint64_t{view.nodeCount()} * std::min<std::uint64_t>(arrays[i].components, 64) * 4;
    if (bytes.size() != expected)
      return issues.add({ErrorCode::ChunkLength,
                         chunks.nodeArrays[i].entryOffset + 16,
                         "chunk NARR of " + arrays[i].name.substr(0, 80) + " has " +
                             std::to_string(bytes.size()) + " bytes, expected " +
                             std::to_string(expected),
                         {{"chunk", "NARR"},
                          {"found", std::to_string(bytes.size())},
                          {"expected", std::to_string(expected)}}});
    std::visit(
        [bytes](auto& values) {
          using Number = typename std::remove_reference_t<decltype(values)>::value_type;
          values.resize(bytes.size() / sizeof(Number));
          for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = loadLittle<Number>(bytes.data() + sizeof(Number) * k);
        },
        arrays[i].values);
  }
}

// Fills the case; its rules are not checked yet.
Case caseOf(const CaseView& view, const CaseChunks& chunks, MetadataDocument&& document) {
  Case value;
  value.metadata = std::move(document.metadata);
  value.nodeArrays = std::move(document.nodeArrays);
  value.tree = treeOf(view);
  if (view.hasPoints)
    value.points = PointSets{copied(view.pointOffset), copied(view.pointPosition)};
  if (view.models) value.models = modelsOf(*view.models);
  if (view.motion) value.motion = motionOf(*view.motion);
  for (const Chunk& chunk : chunks.others) value.otherChunks.push_back(otherChunk(chunk));
  return value;
}

// The byte offset of a value of a node array.
std::optional<std::uint64_t> nodeArrayOffset(const std::string& pointer, const Case& value,
                                             const CaseChunks& chunks) {
  for (std::size_t i = 0; i < value.nodeArrays.size() && i < chunks.nodeArrays.size(); ++i) {
    const std::string start = "/nodeArrays/" + jsonPointerToken(value.nodeArrays[i].name) + "/";
    if (!pointer.starts_with(start)) continue;
    const Chunk& chunk = chunks.nodeArrays[i];
    const auto index = std::strtoull(pointer.c_str() + start.size(), nullptr, 10);
    return chunk.offset + (chunk.encoding == 0 ? 4 * index : 0);
  }
  return std::nullopt;
}

void placeIssues(const Case& value, const CaseChunks& chunks, IssueList& issues) {
  issues.forEach([&](Issue& issue) {
    if (issue.offset || !issue.pointer) return;
    issue.offset = findByteOffset(*issue.pointer, chunks);
    if (!issue.offset) issue.offset = nodeArrayOffset(*issue.pointer, value, chunks);
  });
}

std::optional<Case> decodeChunks(const Container& container, CaseChunks& chunks,
                                 IssueList& issues) {
  const DecodedChunks decoded(chunks, issues);
  if (issues.failed()) return std::nullopt;
  const CaseView view = assembleView(chunks, Verify::All, issues);
  const bool rightSizes = !issues.failed();
  const Chunk& metadata = chunks.at(chunk::kMetadata);
  const std::uint64_t textAt = metadata.offset;
  MetadataDocument document =
      decodeMetadataJson(view.metadata, textAt, container.fullyKnown(), issues);
  if (!rightSizes) {
    placeIssues({}, chunks, issues);
    return std::nullopt;
  }
  const bool rightMetadata = !issues.failed();
  if (rightMetadata) readNodeArrays(view, chunks, document.nodeArrays, issues);
  Case value = caseOf(view, chunks, std::move(document));
  if (rightMetadata && !issues.failed())
    checkCase(value, issues);
  else
    checkModelRules(view, issues);
  placeIssues(value, chunks, issues);
  if (issues.failed()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Case> decodeBinary(std::span<const std::byte> bytes, IssueList& issues) {
  // numbers are read in place, for which the bytes must be aligned
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 != 0)
    return decodeBinary(copied(bytes), issues);
  const auto container = readContainer(bytes);
  if (!container) {
    issues.add(container.error());
    return std::nullopt;
  }
  for (const Chunk& chunk : container->chunks)
    if (auto verified = verifyChunk(chunk); !verified) issues.add(verified.error());
  CaseChunks chunks = sortChunks(*container, issues);
  if (issues.failed()) return std::nullopt;
  return decodeChunks(*container, chunks, issues);
}

Expected<Case> decodeBinary(std::span<const std::byte> bytes) {
  IssueList issues(1, IssueList::Keep::Errors);
  auto value = decodeBinary(bytes, issues);
  if (auto error = issues.firstError()) return *std::move(error);
  return *std::move(value);
}

}  // namespace lumen::formats
