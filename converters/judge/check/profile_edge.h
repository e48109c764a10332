// SPDX-License-Identifier: Apache-2.0
// Where a profile across a wall has its edge (docs/method.md, section 7.1).
#pragma once

#include <cstddef>
#include <span>

namespace lumen::convert {

/// Samples in a voxel's edge: profiles are taken that dense.
constexpr int kSamplesPerVoxel = 8;

enum class EdgeKind {
  None,   ///< nothing changes, or too little of the profile lies in the volume
  Falls,  ///< from the lumen to the background
  Rises,  ///< the wrong polarity: brighter outside
};

struct ProfileEdge {
  EdgeKind kind = EdgeKind::None;
  double at = 0;        ///< samples outward of the wall
  double steepest = 0;  ///< the same, of the place where it changes most over one voxel
  double inside = 0;    ///< level on the inner side of the edge
  double outside = 0;   ///< level on the outer side
  [[nodiscard]] double contrast() const { return inside - outside; }
  [[nodiscard]] double half() const { return 0.5 * (inside + outside); }
};

/// The edge of `values`, which run from inside outwards, with the wall at index `wall`; NaN is
/// outside of the volume. Of the places that fall over one voxel at least half as much as the
/// profile changes anywhere over one voxel, the one nearest to the wall; there the place of the
/// half level, or the steepest one where the profile does not pass the half level. Rises if such a
/// rise lies nearer to the wall by more than a voxel, or nothing falls.
ProfileEdge findEdge(std::span<const float> values, std::size_t wall);

}  // namespace lumen::convert
