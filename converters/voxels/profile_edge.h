// SPDX-License-Identifier: Apache-2.0
// Detection of the edge in a profile across a wall (docs/method.md, section 7.1).
#pragma once

#include <cstddef>
#include <span>

namespace lumen::convert {

/// Samples per voxel edge in a profile.
constexpr int kSamplesPerVoxel = 8;

/// Extent of profiles inward and outward from the wall of a vessel of this radius, mm.
struct ProfileReach {
  double inward, outward;
};
ProfileReach profileReach(double radius, double voxel);

enum class EdgeKind {
  None,   ///< no change, or too little of the profile lies in the volume
  Falls,  ///< from the lumen to the background
  Rises,  ///< wrong polarity: brighter outside
};

struct ProfileEdge {
  EdgeKind kind = EdgeKind::None;
  double at = 0;        ///< samples outward of the wall
  double steepest = 0;  ///< samples outward of the wall to the steepest change over one voxel
  double inside = 0;    ///< level on the inner side of the edge
  double outside = 0;   ///< level on the outer side
  [[nodiscard]] double contrast() const { return inside - outside; }
  [[nodiscard]] double half() const { return 0.5 * (inside + outside); }
};

/// The edge of `values`, which run from inside outwards, with the wall at index `wall`; NaN is
/// outside of the volume. Candidates are places whose fall over one voxel is at least half of the
/// profile's greatest change over one voxel; the one nearest to the wall counts. The edge is there
/// at the half level, or at the steepest place where the profile does not pass the half level.
/// Rises if such a rise lies nearer to the wall by more than a voxel, or if there is no fall.
ProfileEdge findEdge(std::span<const float> values, std::size_t wall);

/// The steepest place of a profile across a wall.
struct FallWidth {
  std::size_t at = 0;  ///< a sample
  double width =
      0;  ///< samples, in full at half height; 0 if it does not fall to half on both sides
};

/// The maximum of `fall`, the fall of a profile from sample to sample, within `near` samples of its
/// middle, and its width. A Gaussian blur of standard deviation s makes a flat wall 2.3548 s wide.
FallWidth fallWidth(std::span<const double> fall, std::size_t near);

/// Full width at half height of the Gaussian exp(-x^2/2).
constexpr double kWidthAtHalfHeight = 2.3548200450309493;

}  // namespace lumen::convert
