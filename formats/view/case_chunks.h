// SPDX-License-Identifier: Apache-2.0
// The chunks of a case in the binary encoding; see spec/lumen.md, "Chunks of a case".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/container/container.h"

namespace lumen::formats {

/// Chunk types in canonical order. Arrays are little-endian and packed, so a mapped file is used in
/// place.
namespace chunk {
inline constexpr ChunkType kMetadata = chunkType("META");        ///< JSON, UTF-8
inline constexpr ChunkType kNodeCentre = chunkType("NCEN");      ///< f32[3] per node
inline constexpr ChunkType kNodeDirection = chunkType("NDIR");   ///< f32[3] per node
inline constexpr ChunkType kNodeRadius = chunkType("NRAD");      ///< f32 per node
inline constexpr ChunkType kNodeHeight = chunkType("NHEI");      ///< f32 per node
inline constexpr ChunkType kNodeParent = chunkType("NPAR");      ///< i32 per node
inline constexpr ChunkType kNodeBranch = chunkType("NBRA");      ///< u32 per node
inline constexpr ChunkType kNodeInlierRate = chunkType("NINL");  ///< f32 per node
inline constexpr ChunkType kBranchRecords = chunkType("BREC");   ///< kBranchRecordSize per branch
inline constexpr ChunkType kBranchLabels = chunkType("BLAB");    ///< UTF-8, one after another
inline constexpr ChunkType kLinks = chunkType("LINK");           ///< u32[2] per link
inline constexpr ChunkType kPointOffset = chunkType("POFF");     ///< u32 per node, and one more
inline constexpr ChunkType kPointPosition = chunkType("PPOS");   ///< f32[3] per point
inline constexpr ChunkType kModelKernel = chunkType("MKER");     ///< one kernel record
inline constexpr ChunkType kModelOffset = chunkType("MOFF");     ///< u32 per node, and one more
inline constexpr ChunkType kModelCentre = chunkType("MCEN");     ///< f32[3] per blob
inline constexpr ChunkType kModelWidth = chunkType("MWID");      ///< f32 per blob
/// The values of one node array; occurs once for each that the metadata describes, in that order.
inline constexpr ChunkType kNodeArray = chunkType("NARR");
/// Poses of nodes over time: kMotionHeadSize bytes, times, nodes, and kPoseSize bytes per pose.
inline constexpr ChunkType kMotion = chunkType("MOVE");
/// Seeds, as a text of the seeds format (spec/lumen.md, "Seeds"). The model holds it as it holds
/// chunks of unknown types, so that a program without seeds keeps it.
inline constexpr ChunkType kSeeds = chunkType("SEED");
}  // namespace chunk

inline constexpr std::size_t kBranchRecordSize = 24;
inline constexpr std::size_t kKernelRecordSize = 24;
inline constexpr std::size_t kMotionHeadSize = 16;
inline constexpr std::size_t kPoseSize = 32;

/// The mean inlier rate of a branch that has none.
inline constexpr float kNoRate = -1.0f;

enum class ChunkNeed : std::uint8_t { Always, Alone, Points, Models, Repeated };

struct ChunkRule {
  ChunkType type;
  bool critical;        ///< the tree cannot be understood without it
  ChunkNeed need;       ///< when it must be there: always, or with the others of its group
  std::uint8_t stride;  ///< bytes of an element; 1 for text
};

inline constexpr std::array<ChunkRule, 19> kChunkRules = {{
    {chunk::kMetadata, true, ChunkNeed::Always, 1},
    {chunk::kNodeCentre, true, ChunkNeed::Always, 12},
    {chunk::kNodeDirection, true, ChunkNeed::Always, 12},
    {chunk::kNodeRadius, true, ChunkNeed::Always, 4},
    {chunk::kNodeHeight, true, ChunkNeed::Always, 4},
    {chunk::kNodeParent, true, ChunkNeed::Always, 4},
    {chunk::kNodeBranch, true, ChunkNeed::Always, 4},
    {chunk::kNodeInlierRate, false, ChunkNeed::Alone, 4},
    {chunk::kBranchRecords, true, ChunkNeed::Always, kBranchRecordSize},
    {chunk::kBranchLabels, true, ChunkNeed::Always, 1},
    {chunk::kLinks, true, ChunkNeed::Alone, 8},
    {chunk::kPointOffset, false, ChunkNeed::Points, 4},
    {chunk::kPointPosition, false, ChunkNeed::Points, 12},
    {chunk::kModelKernel, false, ChunkNeed::Models, kKernelRecordSize},
    {chunk::kModelOffset, false, ChunkNeed::Models, 4},
    {chunk::kModelCentre, false, ChunkNeed::Models, 12},
    {chunk::kModelWidth, false, ChunkNeed::Models, 4},
    {chunk::kNodeArray, false, ChunkNeed::Repeated, 4},
    {chunk::kMotion, false, ChunkNeed::Alone, 4},
}};

/// The place of `type` in kChunkRules; the number of rules if this version does not know it.
std::size_t chunkRuleIndex(ChunkType type);

/// The chunks of a file by their role.
struct CaseChunks {
  std::array<std::optional<Chunk>, kChunkRules.size()> byRule;  ///< all but the repeated ones
  std::vector<Chunk> nodeArrays;                                ///< in file order
  std::vector<Chunk> others;  ///< unknown types, not critical, in file order

  /// The chunk of a known type, or nullptr.
  [[nodiscard]] const Chunk* find(ChunkType type) const {
    const auto& found = byRule[chunkRuleIndex(type)];
    return found ? &*found : nullptr;
  }
  /// The chunk of a known type, which must be there.
  [[nodiscard]] const Chunk& at(ChunkType type) const { return *byRule[chunkRuleIndex(type)]; }
};

/// Checks type, version, flags and presence, but reads no chunk. Reports to `issues`; the result is
/// complete if they have no error.
CaseChunks sortChunks(const Container& container, IssueList& issues);

}  // namespace lumen::formats
