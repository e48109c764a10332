// SPDX-License-Identifier: Apache-2.0
// Distance of a case's wall from the edges of its volume (docs/method.md, section 7.1).
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/check/lumen_voxels.h"
#include "converters/voxels/bspline.h"
#include "converters/voxels/profile_edge.h"
#include "formats/case/case.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

struct EdgeOptions {
  double pointSpread = 0;  ///< standard deviation of the volume's blur, mm; 0: edges are not moved
  bool dark = false;       ///< vessels are darker than their background
};

enum class Verdict : std::uint8_t {
  Edge,           ///< the volume has an edge here: `offset` holds
  NoEdge,         ///< no edge within reach, or too little contrast
  WrongPolarity,  ///< the volume becomes brighter outwards
  BesideAnother,  ///< another part of the tree begins outside: not judged
  OutsideVolume,  ///< not judged
};

/// One place of the wall.
struct WallOffset {
  std::uint32_t node = 0;
  Verdict verdict = Verdict::NoEdge;
  double offset = 0;               ///< mm outward of the volume's edge to the wall
  double fromSteepest = 0;         ///< mm outward of the steepest change of intensity
  double displaced = 0;            ///< mm outward of such a wall to the edge, by the blur
  double inside = 0, outside = 0;  ///< levels on the two sides, voxel units, brighter is more
  double beyond = 0;               ///< level at the far end of the profile, if one was taken
};

/// The wall's offsets, sorted by node. Throws Error(Cancelled).
std::vector<WallOffset> wallOffsets(const formats::CenterlineTree& tree,
                                    const field::BlendedField& surface, const BsplineVolume& volume,
                                    const LumenVoxels& lumen, const EdgeOptions& options,
                                    Progress& progress);

/// Intensity levels that separate lumen from background around a node; brighter is more, so values
/// are negative if vessels are dark.
struct NodeLevels {
  float half = 0;   ///< halfway between lumen and background
  float faint = 0;  ///< a quarter up to the lumen, or the top of the background's texture
};

/// The levels of each node: medians over the edges of the nodes around it in its branch, of the
/// whole branch where these have no edge, of the whole tree where the branch has none. Empty if
/// there is no edge at all.
std::vector<NodeLevels> nodeLevels(const formats::CenterlineTree& tree,
                                   const std::vector<WallOffset>& offsets);

}  // namespace lumen::convert
