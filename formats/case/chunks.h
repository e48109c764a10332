// SPDX-License-Identifier: Apache-2.0
// The chunks of a case in the binary encoding; see spec/lumen.md, "Chunks of a case".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/container/container.h"

namespace lumen::formats {

/// In canonical order. Arrays are little-endian and packed, so a mapped file is used in place.
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
inline constexpr ChunkType kPointOffset = chunkType("POFF");     ///< u32 per node, and one more
inline constexpr ChunkType kPointPosition = chunkType("PPOS");   ///< f32[3] per point
inline constexpr ChunkType kModelKernel = chunkType("MKER");     ///< one kernel record
inline constexpr ChunkType kModelOffset = chunkType("MOFF");     ///< u32 per node, and one more
inline constexpr ChunkType kModelCentre = chunkType("MCEN");     ///< f32[3] per blob
inline constexpr ChunkType kModelWidth = chunkType("MWID");      ///< f32 per blob
}  // namespace chunk

inline constexpr std::size_t kBranchRecordSize = 24;
inline constexpr std::size_t kKernelRecordSize = 24;

/// The mean inlier rate of a branch that has none.
inline constexpr float kNoRate = -1.0f;

struct ChunkRule {
  ChunkType type;
  bool critical;  ///< the tree cannot be understood without it
};

inline constexpr std::array<ChunkRule, 16> kChunkRules = {{
    {chunk::kMetadata, true},
    {chunk::kNodeCentre, true},
    {chunk::kNodeDirection, true},
    {chunk::kNodeRadius, true},
    {chunk::kNodeHeight, true},
    {chunk::kNodeParent, true},
    {chunk::kNodeBranch, true},
    {chunk::kNodeInlierRate, false},
    {chunk::kBranchRecords, true},
    {chunk::kBranchLabels, true},
    {chunk::kPointOffset, false},
    {chunk::kPointPosition, false},
    {chunk::kModelKernel, false},
    {chunk::kModelOffset, false},
    {chunk::kModelCentre, false},
    {chunk::kModelWidth, false},
}};

}  // namespace lumen::formats
