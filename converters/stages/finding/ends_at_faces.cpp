// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/ends_at_faces.h"

#include <algorithm>

namespace lumen::convert {
namespace {

/// Depth that a place must gain over the tip for each mm that it lies away: on the way from a corner
/// to the middle of a section the depth grows by 1 in a square one, and by less in a slanted one;
/// along a vessel that runs in a face it does not grow.
constexpr double kGain = 0.5;
/// Least ratio of the depths where a path enters the section's ball and in its middle. Below it the
/// section is that of another, wider vessel.
constexpr double kSameVessel = 2.0 / 3.0;

bool isAtFace(const VoxelSet& set, std::uint32_t i) {
  const Cell cell = set.cell(i), high = set.geometry().cells().high();
  for (int a = 0; a < 3; ++a)
    if (high[a] > 0 && (cell[a] == 0 || cell[a] == high[a])) return true;
  return set.geometry().isBesideNoImage(cell);
}

/// The number of voxels of a path, from its beginning, that lie outside of the ball around `middle`.
std::size_t countOutside(const VoxelSet& set, std::span<const float> depths,
                         const std::vector<std::uint32_t>& voxels, std::uint32_t middle) {
  std::size_t kept = voxels.size();
  const auto isIn = [&](std::uint32_t i) {
    return (set.position(i) - set.position(middle)).norm() <= double{depths[middle]};
  };
  // the corner itself may lie beyond the ball
  while (kept > 0 && !isIn(voxels[kept - 1])) --kept;
  while (kept > 0 && isIn(voxels[kept - 1])) --kept;
  return kept;
}

}  // namespace

void endAtFace(const VoxelSet& set, std::span<const float> depths,
               std::vector<std::uint32_t>& voxels) {
  if (voxels.size() < 2 || !isAtFace(set, voxels.back())) return;
  const std::uint32_t tip = voxels.back();
  double widest = 0;
  for (const std::uint32_t i : voxels) widest = std::max(widest, double{depths[i]});
  double most = double{depths[tip]};
  std::uint32_t middle = tip;
  std::size_t kept = voxels.size();
  set.eachWithin(tip, widest / kGain, [&](std::uint32_t j) {
    const double depth{depths[j]};
    const double gain = depth - kGain * (set.position(j) - set.position(tip)).norm();
    if (gain <= most || !isAtFace(set, j)) return;
    const std::size_t outside = countOutside(set, depths, voxels, j);
    if (outside == 0 || double{depths[voxels[outside - 1]]} < kSameVessel * depth) return;
    most = gain;
    middle = j;
    kept = outside;
  });
  if (middle == tip) return;
  voxels.resize(kept);
  voxels.push_back(middle);
}

}  // namespace lumen::convert
