// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "formats/case/case_file.h"
#include "formats/case/chunks.h"
#include "formats/case/error_text.h"
#include "formats/case/metadata_json.h"
#include "formats/container/bytes.h"

namespace lumen::formats {
namespace {

using Problem = std::optional<FormatError>;

FormatError fromContainer(const ContainerError& error) {
  return makeError(error.code, bytePlace(error.offset), error.message);
}

FormatError chunkError(ErrorCode code, const Chunk& chunk, const std::string& message) {
  return makeError(code, bytePlace(chunk.offset), "chunk " + chunkName(chunk.type) + " " + message);
}

// The chunks that this version knows, each at its place in kChunkRules, all verified.
struct KnownChunks {
  std::array<std::optional<Chunk>, kChunkRules.size()> byRule;

  [[nodiscard]] const std::optional<Chunk>& operator[](ChunkType type) const {
    const auto rule = std::find_if(kChunkRules.begin(), kChunkRules.end(),
                                   [type](const ChunkRule& r) { return r.type == type; });
    return byRule[static_cast<std::size_t>(rule - kChunkRules.begin())];
  }
};

Problem checkKnown(const Chunk& chunk, const ChunkRule& rule) {
  if (chunk.version != 1)
    return chunkError(ErrorCode::ChunkVersion, chunk,
                      "has version " + std::to_string(chunk.version) + ", this reader knows 1");
  if (chunk.encoding != static_cast<std::uint8_t>(ChunkEncoding::Raw))
    return chunkError(ErrorCode::ChunkEncoding, chunk,
                      "has encoding " + std::to_string(chunk.encoding) + ", this reader knows 0");
  if (chunk.critical != rule.critical)
    return chunkError(ErrorCode::ChunkField, chunk,
                      rule.critical ? "must be marked critical" : "must not be marked critical");
  return std::nullopt;
}

Problem placeChunk(const Chunk& chunk, KnownChunks& known) {
  if (auto verified = verifyChunk(chunk); !verified) return fromContainer(verified.error());
  for (std::size_t i = 0; i < kChunkRules.size(); ++i) {
    if (kChunkRules[i].type != chunk.type) continue;
    if (known.byRule[i])
      return chunkError(ErrorCode::ChunkDuplicate, chunk, "occurs a second time");
    known.byRule[i] = chunk;
    return checkKnown(chunk, kChunkRules[i]);
  }
  if (chunk.critical)
    return chunkError(ErrorCode::ChunkUnknown, chunk,
                      "is critical, and this reader does not know it");
  return std::nullopt;
}

// Of a group that comes together, the members that are absent while another is there.
Problem checkTogether(const KnownChunks& known, std::initializer_list<ChunkType> group,
                      bool required) {
  const bool wanted = required || std::any_of(group.begin(), group.end(), [&](ChunkType type) {
                        return known[type].has_value();
                      });
  for (const ChunkType type : group)
    if (wanted && !known[type])
      return makeError(ErrorCode::ChunkMissing, bytePlace(kHeaderSize),
                       "the chunk table has no chunk " + chunkName(type));
  return std::nullopt;
}

Problem checkPresence(const KnownChunks& known) {
  using namespace chunk;
  if (auto p = checkTogether(known,
                             {kMetadata, kNodeCentre, kNodeDirection, kNodeRadius, kNodeHeight,
                              kNodeParent, kNodeBranch, kBranchRecords, kBranchLabels},
                             true))
    return p;
  if (auto p = checkTogether(known, {kPointOffset, kPointPosition}, false)) return p;
  return checkTogether(known, {kModelKernel, kModelOffset, kModelCentre, kModelWidth}, false);
}

// Reads chunks into arrays and keeps the first problem; after one, it reads nothing more.
class ArrayReader {
public:
  explicit ArrayReader(const KnownChunks& known) : m_known(known) {}

  template <class Number>
  void read(ChunkType type, std::vector<Number>& to) {
    const auto bytes = elements(type, sizeof(Number));
    to.resize(bytes.size() / sizeof(Number));
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = loadLittle<Number>(bytes.data() + sizeof(Number) * i);
  }

  void read(ChunkType type, std::vector<Vec3f>& to) {
    const auto bytes = elements(type, 12);
    to.resize(bytes.size() / 12);
    for (std::size_t i = 0; i < to.size(); ++i) {
      const std::byte* from = bytes.data() + 12 * i;
      to[i] = {loadLittle<float>(from), loadLittle<float>(from + 4), loadLittle<float>(from + 8)};
    }
  }

  // The chunk's bytes if they are a whole number of elements; nothing after a problem.
  std::span<const std::byte> elements(ChunkType type, std::size_t elementSize) {
    if (m_problem) return {};
    const Chunk& chunk = *m_known[type];
    if (chunk.stored.size() % elementSize == 0) return chunk.stored;
    m_problem = chunkError(ErrorCode::ChunkLength, chunk,
                           "has " + std::to_string(chunk.stored.size()) +
                               " bytes, expected a multiple of " + std::to_string(elementSize));
    return {};
  }

  [[nodiscard]] const Problem& problem() const { return m_problem; }

private:
  const KnownChunks& m_known;
  Problem m_problem;
};

std::string textOf(std::span<const std::byte> bytes) {
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  return text;
}

Problem readBranches(const Chunk& records, const Chunk& labels, std::vector<Branch>& branches) {
  const std::size_t count = records.stored.size() / kBranchRecordSize;
  branches.reserve(count);
  ByteCursor cursor(records.stored);
  ByteCursor labelCursor(labels.stored);
  for (std::size_t b = 0; b < count; ++b) {
    Branch branch;
    branch.firstNode = cursor.read<std::uint32_t>();
    branch.nodeCount = cursor.read<std::uint32_t>();
    branch.parentNode = cursor.read<std::int32_t>();
    const auto labelOffset = cursor.read<std::uint32_t>();
    const auto labelSize = cursor.read<std::uint16_t>();
    branch.kind = static_cast<BranchKind>(cursor.read<std::uint8_t>());
    branch.stopReason = static_cast<StopReason>(cursor.read<std::uint8_t>());
    const auto rate = cursor.read<float>();
    if (rate != kNoRate) branch.meanInlierRate = rate;
    const bool adjacent = labelOffset == labelCursor.position();
    branch.label = textOf(labelCursor.take(labelSize));
    if (!adjacent || labelCursor.failed())
      return chunkError(ErrorCode::ChunkLength, labels,
                        "should hold " + std::to_string(labelSize) + " bytes at " +
                            std::to_string(labelOffset) + " for the label of branch " +
                            std::to_string(b) + ", right after the label before");
    branches.push_back(std::move(branch));
  }
  if (labelCursor.position() != labels.stored.size())
    return chunkError(ErrorCode::ChunkLength, labels, "has bytes after the last label");
  return std::nullopt;
}

Problem readKernel(const Chunk& record, BlobbyModels& models) {
  ByteCursor cursor(record.stored);
  models.kernel = static_cast<Kernel>(cursor.read<std::uint8_t>());
  for (const std::byte b : cursor.take(7))
    if (b != std::byte{0})
      return chunkError(ErrorCode::ChunkField, record, "has a reserved byte that is not zero");
  models.kernelParameter = cursor.read<double>();
  models.isoLevel = cursor.read<double>();
  if (cursor.failed() || cursor.position() != record.stored.size())
    return chunkError(ErrorCode::ChunkLength, record,
                      "has " + std::to_string(record.stored.size()) + " bytes, expected " +
                          std::to_string(kKernelRecordSize));
  return std::nullopt;
}

Problem readTree(const KnownChunks& known, CenterlineTree& tree) {
  ArrayReader arrays(known);
  arrays.read(chunk::kNodeCentre, tree.centre);
  arrays.read(chunk::kNodeDirection, tree.direction);
  arrays.read(chunk::kNodeRadius, tree.radius);
  arrays.read(chunk::kNodeHeight, tree.height);
  arrays.read(chunk::kNodeParent, tree.parent);
  arrays.read(chunk::kNodeBranch, tree.branch);
  if (known[chunk::kNodeInlierRate]) arrays.read(chunk::kNodeInlierRate, tree.inlierRate);
  arrays.elements(chunk::kBranchRecords, kBranchRecordSize);
  if (arrays.problem()) return arrays.problem();
  return readBranches(*known[chunk::kBranchRecords], *known[chunk::kBranchLabels], tree.branches);
}

Problem readPoints(const KnownChunks& known, PointSets& points) {
  ArrayReader arrays(known);
  arrays.read(chunk::kPointOffset, points.offset);
  arrays.read(chunk::kPointPosition, points.position);
  return arrays.problem();
}

Problem readModels(const KnownChunks& known, BlobbyModels& models) {
  if (auto p = readKernel(*known[chunk::kModelKernel], models)) return p;
  ArrayReader arrays(known);
  arrays.read(chunk::kModelOffset, models.offset);
  arrays.read(chunk::kModelCentre, models.centre);
  arrays.read(chunk::kModelWidth, models.width);
  return arrays.problem();
}

Problem readMetadata(const Chunk& chunk, bool fullyKnown, Metadata& metadata) {
  auto decoded = decodeMetadataJson(textOf(chunk.stored), chunk.offset, fullyKnown);
  if (!decoded) return decoded.error();
  metadata = *std::move(decoded);
  return std::nullopt;
}

}  // namespace

Result<Case> decodeBinary(std::span<const std::byte> bytes) {
  auto container = readContainer(bytes);
  if (!container) return fromContainer(container.error());
  KnownChunks known;
  for (const Chunk& chunk : container->chunks)
    if (auto p = placeChunk(chunk, known)) return *std::move(p);
  if (auto p = checkPresence(known)) return *std::move(p);

  Case value;
  if (auto p = readMetadata(*known[chunk::kMetadata], container->fullyKnown(), value.metadata))
    return *std::move(p);
  if (auto p = readTree(known, value.tree)) return *std::move(p);
  if (known[chunk::kPointOffset])
    if (auto p = readPoints(known, value.points.emplace())) return *std::move(p);
  if (known[chunk::kModelKernel])
    if (auto p = readModels(known, value.models.emplace())) return *std::move(p);
  if (auto valid = validate(value); !valid) return valid.error();
  return value;
}

}  // namespace lumen::formats
