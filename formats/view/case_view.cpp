// SPDX-License-Identifier: Apache-2.0
#include "formats/view/case_view.h"

#include <algorithm>
#include <bit>

#include "formats/container/bytes.h"
#include "formats/view/limits.h"
#include "formats/view/model_rules.h"

namespace lumen::formats {
namespace {

constexpr std::size_t kAlignment = 8;

std::optional<Issue> checkMemory(std::span<const std::byte> bytes) {
  if constexpr (std::endian::native != std::endian::little)
    return Issue{ErrorCode::ViewMemory, std::nullopt,
                 "this machine is big-endian, so the file's numbers cannot be used in place"};
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0)
    return Issue{ErrorCode::ViewMemory, std::nullopt,
                 "the bytes do not start at a multiple of 8 in memory"};
  return std::nullopt;
}

Issue sizeIssue(const Chunk& chunk, std::uint64_t expected) {
  const std::string name = chunkName(chunk.type);
  return {ErrorCode::ChunkLength,
          chunk.entryOffset + 16,
          "chunk " + name + " has " + std::to_string(chunk.stored.size()) + " bytes, expected " +
              std::to_string(expected),
          {{"chunk", name},
           {"found", std::to_string(chunk.stored.size())},
           {"expected", std::to_string(expected)}}};
}

std::optional<Issue> checkRaw(const Chunk& chunk) {
  if (chunk.encoding == static_cast<std::uint8_t>(ChunkEncoding::Raw)) return std::nullopt;
  const std::string name = chunkName(chunk.type);
  return Issue{ErrorCode::ChunkEncoding,
               chunk.entryOffset + 7,
               "chunk " + name + " is stored in encoding " + std::to_string(chunk.encoding) +
                   " and cannot be used in place; lumen convert writes it raw",
               {{"chunk", name}, {"found", std::to_string(chunk.encoding)}}};
}

// Fills spans from chunks.
class SpanReader {
public:
  SpanReader(const CaseChunks& chunks, std::uint64_t nodeCount, IssueList& issues)
      : m_chunks(chunks), m_nodeCount(nodeCount), m_issues(issues) {}

  /// Reads an array of a whole number of elements; empty if the file does not have it. False with
  /// an issue.
  template <class T>
  bool any(ChunkType type, std::span<const T>& to) {
    const Chunk* chunk = m_chunks.find(type);
    if (chunk == nullptr) return true;
    const std::size_t count = chunk->stored.size() / sizeof(T);
    to = {reinterpret_cast<const T*>(chunk->stored.data()), count};
    return require(*chunk, chunk->stored.size(), count * sizeof(T));
  }

  /// Reads an array of one element per node and `more`.
  template <class T>
  void each(ChunkType type, std::span<const T>& to, std::uint64_t more = 0) {
    const Chunk* chunk = m_chunks.find(type);
    if (chunk != nullptr && any(type, to))
      require(*chunk, chunk->stored.size(), (m_nodeCount + more) * sizeof(T));
  }

  void kernel(ChunkType type, ModelView& model) {
    const Chunk& record = m_chunks.at(type);
    if (!require(record, record.stored.size(), kKernelRecordSize)) return;
    const auto reserved = record.stored.subspan(1, 7);
    const auto used = std::find_if(reserved.begin(), reserved.end(),
                                   [](std::byte b) { return b != std::byte{0}; });
    if (used != reserved.end())
      m_issues.add({ErrorCode::ChunkField,
                    record.offset + 1 + static_cast<std::uint64_t>(used - reserved.begin()),
                    "chunk " + chunkName(type) + " has a reserved byte that is not zero",
                    {{"chunk", chunkName(type)}}});
    readKernelRecord(record.stored, model);
  }

  bool require(const Chunk& chunk, std::uint64_t found, std::uint64_t expected) {
    if (found != expected) m_issues.add(sizeIssue(chunk, expected));
    return found == expected;
  }

private:
  const CaseChunks& m_chunks;
  std::uint64_t m_nodeCount;
  IssueList& m_issues;
};

void readModels(SpanReader& reader, const CaseChunks& chunks, ModelView& models) {
  reader.kernel(chunk::kModelKernel, models);
  reader.each(chunk::kModelOffset, models.offset, 1);
  reader.any(chunk::kModelCentre, models.centre);
  reader.any(chunk::kModelWidth, models.width);
  reader.require(chunks.at(chunk::kModelWidth), models.width.size_bytes(),
                 models.centre.size() * sizeof(float));
}

// A count beyond its limit; it may be beyond the sizes of the machine, too.
Issue foundLimit(const char* pointer, std::uint64_t found, std::size_t limit) {
  const std::string text = std::to_string(found), most = std::to_string(limit);
  return pointerIssue(ErrorCode::Limit, pointer, "found " + text + ", the limit is " + most,
                      {{"found", text}, {"limit", most}});
}

// Size of the chunk of a motion by the counts in its head; nothing if these exceed their limits.
std::optional<std::uint64_t> motionSize(std::uint64_t times, std::uint64_t nodes) {
  if (times > kMaxTimes || times * nodes > kMaxPoses) return std::nullopt;
  return kMotionHeadSize + 8 * times + 4 * nodes + kPoseSize * times * nodes;
}

std::string_view textOf(const Chunk& chunk) {
  return {reinterpret_cast<const char*>(chunk.stored.data()), chunk.stored.size()};
}

constexpr std::uint64_t kLabelOffsetAt = 12, kLabelSizeAt = 16;  // in a record

// A fault of a field of a branch's record that describes its label.
Issue labelIssue(ErrorCode code, const Chunk& records, std::size_t branch, std::uint64_t field,
                 std::string message) {
  std::optional<std::uint64_t> at = records.offset;
  if (records.encoding == 0) *at += branch * kBranchRecordSize + field;
  return {code, at, std::move(message), {}, "/tree/branches/" + std::to_string(branch) + "/label"};
}

// Checks that labels follow each other from the chunk's first byte to its last. Where one does not
// start at the end of the previous one, the size of the previous one is at fault if the rest
// agrees.
void checkLabels(const CaseView& view, const CaseChunks& chunks, IssueList& issues) {
  const Chunk& records = chunks.at(chunk::kBranchRecords);
  const std::uint64_t count = view.branchCount(), size = view.branchLabels.size();
  const auto startOf = [&](std::uint64_t b) {
    return b < count ? std::uint64_t{view.branch(b).labelOffset} : size;
  };
  std::uint64_t next = 0;
  for (std::size_t b = 0; b < count; ++b) {
    const BranchView branch = view.branch(b);
    if (branch.labelOffset != next) {
      const bool agrees = b > 0 && branch.labelOffset + branch.labelSize == startOf(b + 1);
      const std::string found = std::to_string(branch.labelOffset), expected = std::to_string(next);
      Issue issue =
          labelIssue(ErrorCode::LabelOffset, records, agrees ? b - 1 : b,
                     agrees ? kLabelSizeAt : kLabelOffsetAt,
                     "the label of branch " + std::to_string(b) + " starts at byte " + found +
                         " of BLAB, the labels before it end at byte " + expected);
      issue.arguments = {{"found", found}, {"expected", expected}};
      issues.add(std::move(issue));
      if (agrees) next = branch.labelOffset;
    }
    next += branch.labelSize;
  }
  if (next == size) return;
  Issue issue = sizeIssue(chunks.at(chunk::kBranchLabels), next);
  if (count > 0) {
    const std::string message = "the labels of all branches have " + std::to_string(next) +
                                " bytes, chunk BLAB has " + std::to_string(size);
    auto arguments = std::move(issue.arguments);
    issue = labelIssue(issue.code, records, count - 1, kLabelSizeAt, message);
    issue.arguments = std::move(arguments);
  }
  issues.add(std::move(issue));
}

std::optional<Issue> checkChunks(const Container& container, Verify verify) {
  for (const Chunk& chunk : container.chunks) {
    if (chunkRuleIndex(chunk.type) < kChunkRules.size())
      if (auto problem = checkRaw(chunk)) return problem;
    if (verify == Verify::All)
      if (auto verified = verifyChunk(chunk); !verified) return verified.error();
  }
  return std::nullopt;
}

}  // namespace

BranchView CaseView::branch(std::size_t index) const {
  ByteCursor cursor(branchRecords.subspan(index * kBranchRecordSize, kBranchRecordSize));
  BranchView branch;
  branch.firstNode = cursor.read<std::uint32_t>();
  branch.nodeCount = cursor.read<std::uint32_t>();
  branch.parentNode = cursor.read<std::int32_t>();
  branch.labelOffset = cursor.read<std::uint32_t>();
  branch.labelSize = cursor.read<std::uint16_t>();
  branch.kind = cursor.read<std::uint8_t>();
  branch.stopReason = cursor.read<std::uint8_t>();
  branch.meanInlierRate = cursor.read<float>();
  return branch;
}

std::string_view CaseView::label(const BranchView& branch) const {
  if (branch.labelOffset > branchLabels.size() ||
      branch.labelSize > branchLabels.size() - branch.labelOffset)
    return {};
  return branchLabels.substr(branch.labelOffset, branch.labelSize);
}

MotionView viewMotion(const Chunk& chunk, IssueList& issues) {
  MotionView motion;
  const std::uint64_t found = chunk.stored.size();
  if (found < kMotionHeadSize) {
    issues.add(sizeIssue(chunk, kMotionHeadSize));
    return motion;
  }
  ByteCursor cursor(chunk.stored);
  const std::uint64_t times = cursor.read<std::uint32_t>(), nodes = cursor.read<std::uint32_t>();
  const auto period = cursor.read<double>();
  const auto size = motionSize(times, nodes);
  if (!size) {
    const bool isLong = times > kMaxTimes;
    Issue issue = isLong ? foundLimit("/motion/time", times, kMaxTimes)
                         : foundLimit("/motion/centre", times * nodes, kMaxPoses);
    issue.offset = chunk.offset;
    issues.add(std::move(issue));
  } else if (found != *size) {
    issues.add(sizeIssue(chunk, *size));
  } else {
    // the bytes are there, so that their number fits
    const auto k = static_cast<std::size_t>(times), v = static_cast<std::size_t>(nodes);
    const std::byte* at = chunk.stored.data() + kMotionHeadSize;
    motion.period = period;
    motion.time = {reinterpret_cast<const double*>(at), k};
    motion.node = {reinterpret_cast<const std::uint32_t*>(at + 8 * k), v};
    motion.pose = {reinterpret_cast<const PoseRecord*>(at + 8 * k + 4 * v), k * v};
  }
  return motion;
}

CaseView assembleView(const CaseChunks& chunks, Verify verify, IssueList& issues) {
  CaseView view;
  const std::size_t nodeCount = chunks.at(chunk::kNodeCentre).stored.size() / sizeof(Float3);
  SpanReader reader(chunks, nodeCount, issues);
  reader.each(chunk::kNodeCentre, view.nodeCentre);
  reader.each(chunk::kNodeDirection, view.nodeDirection);
  reader.each(chunk::kNodeRadius, view.nodeRadius);
  reader.each(chunk::kNodeHeight, view.nodeHeight);
  reader.each(chunk::kNodeParent, view.nodeParent);
  reader.each(chunk::kNodeBranch, view.nodeBranch);
  reader.each(chunk::kNodeInlierRate, view.nodeInlierRate);
  reader.any(chunk::kBranchRecords, view.branchRecords);
  const Chunk& records = chunks.at(chunk::kBranchRecords);
  const bool wholeRecords =
      reader.require(records, records.stored.size(),
                     records.stored.size() / kBranchRecordSize * kBranchRecordSize);
  view.branchLabels = textOf(chunks.at(chunk::kBranchLabels));
  if (verify == Verify::All && wholeRecords) checkLabels(view, chunks, issues);
  reader.any(chunk::kLinks, view.links);
  view.hasPoints = chunks.find(chunk::kPointOffset) != nullptr;
  reader.each(chunk::kPointOffset, view.pointOffset, 1);
  reader.any(chunk::kPointPosition, view.pointPosition);
  if (chunks.find(chunk::kModelKernel) != nullptr)
    readModels(reader, chunks, view.models.emplace());
  if (const Chunk* motion = chunks.find(chunk::kMotion)) view.motion = viewMotion(*motion, issues);
  view.metadata = textOf(chunks.at(chunk::kMetadata));
  for (const Chunk& chunk : chunks.nodeArrays) view.nodeArrays.push_back(chunk.stored);
  return view;
}

Expected<CaseView> viewCase(std::span<const std::byte> bytes, Verify verify) {
  if (auto problem = checkMemory(bytes)) return *std::move(problem);
  const auto container =
      readContainer(bytes, verify == Verify::All ? Padding::Check : Padding::Skip);
  if (!container) return container.error();
  IssueList issues(1, IssueList::Keep::Errors);
  const CaseChunks chunks = sortChunks(*container, issues);
  if (auto problem = issues.firstError()) return *std::move(problem);
  if (auto problem = checkChunks(*container, verify)) return *std::move(problem);

  CaseView view = assembleView(chunks, verify, issues);
  if (auto problem = issues.firstError()) return *std::move(problem);
  view.version = container->version;
  checkKernels(view, issues);
  if (verify == Verify::All) checkModelRules(view, issues);
  if (auto problem = issues.firstError()) {
    problem->offset = findByteOffset(*problem->pointer, chunks);
    return *std::move(problem);
  }
  return view;
}

}  // namespace lumen::formats
