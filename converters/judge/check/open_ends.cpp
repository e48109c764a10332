// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/open_ends.h"

#include <algorithm>
#include <limits>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Missing vessels begin two voxels outside of the lumen, which ends up to a radius beyond its node.
constexpr double kNearRadii = 2, kNearVoxels = 3;

std::vector<OpenEnd> listOpenEnds(const formats::CenterlineTree& tree) {
  std::vector<std::uint8_t> joined(tree.nodeCount(), 0);
  for (const formats::Branch& branch : tree.branches)
    if (branch.parentNode >= 0) joined[static_cast<std::size_t>(branch.parentNode)] = 1;
  for (const auto& link : tree.links)
    for (const std::uint32_t node : link) joined[node] = 1;
  std::vector<OpenEnd> ends;
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel) continue;
    const std::uint32_t first = branch.firstNode, last = first + branch.nodeCount - 1;
    if (branch.parentNode < 0 && joined[first] == 0)
      ends.push_back({first, true, -toEigen(tree.direction[first]), 0, {}});
    if (joined[last] == 0) ends.push_back({last, false, toEigen(tree.direction[last]), 0, {}});
  }
  return ends;
}

/// Length, mm, from the node along the vessel to its farther tip; 0 if the vessel does not begin
/// there.
double lengthBeyond(const formats::CenterlineTree& tree, const OpenEnd& end, double voxel,
                    const MissingVessel& vessel) {
  const Vector3d centre = toEigen(tree.centre[end.node]);
  double best = kNearRadii * static_cast<double>(tree.radius[end.node]) + kNearVoxels * voxel;
  std::size_t nearest = vessel.path.size();
  for (std::size_t i = 0; i < vessel.path.size(); ++i) {
    const Vector3d away = vessel.path[i].position - centre;
    // a vessel that only passes by comes near with its middle
    const bool tip = i == 0 || i + 1 == vessel.path.size();
    if (away.norm() > best || away.dot(end.outward) <= 0 ||
        (!tip && tree.branch[vessel.path[i].node] != tree.branch[end.node]))
      continue;
    best = away.norm();
    nearest = i;
  }
  if (nearest == vessel.path.size()) return 0;
  const auto share = static_cast<double>(nearest) /
                     static_cast<double>(std::max<std::size_t>(vessel.path.size() - 1, 1));
  return best + std::max(share, 1 - share) * vessel.length;
}

}  // namespace

std::vector<OpenEnd> findOpenEnds(const formats::CenterlineTree& tree, double voxel,
                                  std::vector<MissingVessel>& vessels) {
  std::vector<OpenEnd> ends = listOpenEnds(tree);
  for (OpenEnd& end : ends)
    for (std::size_t v = 0; v < vessels.size(); ++v) {
      const double beyond = lengthBeyond(tree, end, voxel, vessels[v]);
      vessels[v].atEnd = vessels[v].atEnd || beyond > 0;
      if (beyond <= end.goesOn) continue;
      end.goesOn = beyond;
      end.vessel = v;
    }
  return ends;
}

}  // namespace lumen::convert
