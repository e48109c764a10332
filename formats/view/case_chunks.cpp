// SPDX-License-Identifier: Apache-2.0
#include "formats/view/case_chunks.h"

#include <algorithm>

namespace lumen::formats {
namespace {

constexpr std::uint16_t kChunkVersion = 1;

// An issue at a byte of the chunk's entry in the table.
Issue chunkIssue(ErrorCode code, const Chunk& chunk, const std::string& message,
                 std::uint64_t at = 0) {
  const std::string name = chunkName(chunk.type);
  return {code, chunk.entryOffset + at, "chunk " + name + " " + message, {{"chunk", name}}};
}

bool checkKnown(const Chunk& chunk, const ChunkRule& rule, IssueList& issues) {
  if (chunk.version != kChunkVersion) {
    Issue issue =
        chunkIssue(ErrorCode::ChunkVersion, chunk,
                   "has version " + std::to_string(chunk.version) + ", this reader knows 1", 4);
    issue.arguments.push_back({"found", std::to_string(chunk.version)});
    issues.add(std::move(issue));
    return false;
  }
  if (chunk.critical != rule.critical) {
    issues.add(chunkIssue(ErrorCode::ChunkField, chunk,
                          rule.critical ? "must be marked critical" : "must not be marked critical",
                          6));
    return false;
  }
  return true;
}

void addUnknown(const Chunk& chunk, CaseChunks& sorted, IssueList& issues) {
  if (chunk.critical)
    return issues.add(chunkIssue(ErrorCode::ChunkUnknown, chunk,
                                 "is critical, and this reader does not know it"));
  sorted.others.push_back(chunk);
  if (chunk.type == chunk::kSeeds) return;
  issues.add(chunkIssue(ErrorCode::ChunkIgnored, chunk, "is not known and is ignored"));
}

void addChunk(const Chunk& chunk, CaseChunks& sorted, IssueList& issues) {
  const std::size_t index = chunkRuleIndex(chunk.type);
  if (index == kChunkRules.size()) return addUnknown(chunk, sorted, issues);
  const bool legal = checkKnown(chunk, kChunkRules[index], issues);
  if (kChunkRules[index].need == ChunkNeed::Repeated) {
    if (legal) sorted.nodeArrays.push_back(chunk);
    return;
  }
  if (sorted.byRule[index])
    return issues.add(chunkIssue(ErrorCode::ChunkDuplicate, chunk, "occurs a second time"));
  sorted.byRule[index] = chunk;
}

// Reports the members of a group that are absent although required, or although another is there.
void checkPresence(const CaseChunks& sorted, ChunkNeed group, IssueList& issues) {
  bool wanted = group == ChunkNeed::Always;
  for (std::size_t i = 0; i < kChunkRules.size(); ++i)
    if (kChunkRules[i].need == group && sorted.byRule[i]) wanted = true;
  for (std::size_t i = 0; wanted && i < kChunkRules.size(); ++i) {
    if (kChunkRules[i].need != group || sorted.byRule[i]) continue;
    const std::string name = chunkName(kChunkRules[i].type);
    issues.add({ErrorCode::ChunkMissing,
                kHeaderSize,
                "the chunk table has no chunk " + name,
                {{"chunk", name}}});
  }
}

// Reports chunks out of order: equal cases have equal bytes only if all writers keep one order.
void checkOrder(const Container& container, IssueList& issues) {
  std::size_t last = 0;
  for (const Chunk& chunk : container.chunks) {
    const std::size_t index = chunkRuleIndex(chunk.type);
    if (index < last)
      issues.add(chunkIssue(ErrorCode::ChunkOrder, chunk, "should come earlier in the file"));
    last = std::max(last, index);
  }
}

}  // namespace

std::size_t chunkRuleIndex(ChunkType type) {
  const auto rule = std::find_if(kChunkRules.begin(), kChunkRules.end(),
                                 [type](const ChunkRule& r) { return r.type == type; });
  return static_cast<std::size_t>(rule - kChunkRules.begin());
}

CaseChunks sortChunks(const Container& container, IssueList& issues) {
  CaseChunks sorted;
  for (const Chunk& chunk : container.chunks) addChunk(chunk, sorted, issues);
  for (const ChunkNeed group : {ChunkNeed::Always, ChunkNeed::Points, ChunkNeed::Models})
    checkPresence(sorted, group, issues);
  checkOrder(container, issues);
  return sorted;
}

}  // namespace lumen::formats
