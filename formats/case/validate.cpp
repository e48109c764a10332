// SPDX-License-Identifier: Apache-2.0
#include "formats/case/validate.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "formats/case/case_as_view.h"
#include "formats/case/metadata_json.h"
#include "formats/view/limits.h"
#include "formats/view/model_rules.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

bool isLetterOrDigit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool isLegalChunk(const OtherChunk& chunk) {
  if (chunk.type.size() != 4 || !std::all_of(chunk.type.begin(), chunk.type.end(), isLetterOrDigit))
    return false;
  const char name[5] = {chunk.type[0], chunk.type[1], chunk.type[2], chunk.type[3], '\0'};
  if (chunkRuleIndex(chunkType(name)) < kChunkRules.size()) return false;
  if (chunk.encoding == 0) return chunk.rawSize == chunk.bytes.size();
  const bool limited = chunk.encoding <= static_cast<std::uint8_t>(ChunkEncoding::Draco);
  return !limited || chunk.rawSize <= kMaxExpansion * chunk.bytes.size();
}

void checkOtherChunks(const std::vector<OtherChunk>& chunks, IssueList& issues) {
  checkLimit(chunks.size(), kMaxOtherChunks, "/otherChunks", issues);
  for (std::size_t i = 0; i < chunks.size() && !issues.done(); ++i)
    if (!isLegalChunk(chunks[i]))
      issues.add(pointerIssue(ErrorCode::JsonChunkData, "/otherChunks/" + std::to_string(i),
                              "its type is not four letters or digits or is that of a known "
                              "chunk, or its sizes contradict its encoding",
                              {{"chunk", chunks[i].type.substr(0, 4)}}));
}

// Reports the true size of labels beyond 65535 bytes, the greatest size that a record holds.
bool checkLabelSizes(const std::vector<Branch>& branches, IssueList& issues) {
  bool right = true;
  for (std::size_t b = 0; b < branches.size() && !issues.done(); ++b)
    if (const std::size_t size = branches[b].label.size();
        size > std::numeric_limits<std::uint16_t>::max()) {
      issues.add(limitIssue(ErrorCode::TextLength, at("/tree/branches", b) + "/label", size,
                            kMaxNameBytes));
      right = false;
    }
  return right;
}

}  // namespace

void checkCase(const Case& value, IssueList& issues) {
  checkMetadata(value.metadata, issues);
  if (!checkLabelSizes(value.tree.branches, issues)) return;
  const CaseAsView asView(value);
  checkKernels(asView.view(), issues);
  checkModelRules(asView.view(), issues);
  checkNodeArrays(value, issues);
  checkOtherChunks(value.otherChunks, issues);
}

Status validate(const Case& value) {
  IssueList issues(1, IssueList::Keep::Errors);
  checkCase(value, issues);
  if (auto error = issues.firstError()) return *std::move(error);
  return {};
}

void dropDependentChunks(Case& value) {
  std::erase_if(value.otherChunks, [](const OtherChunk& chunk) { return !chunk.independent; });
}

}  // namespace lumen::formats
