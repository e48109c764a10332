// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/unmeasured.h"

#include <algorithm>
#include <cstdint>

#include "converters/base/vectors.h"
#include "converters/stages/fitting/seam.h"
#include "formats/case/node_origin.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Edges along the tree within which another branch's lumen opens the wall: a bridge that leaves
/// its parent has that many nodes beside it.
constexpr int kNearEdges = 12;

}  // namespace

std::vector<std::vector<formats::Vec3f>> pointsOfUnmeasured(const formats::Case& value,
                                                            const formats::Neighbours& neighbours) {
  const formats::CenterlineTree& tree = value.tree;
  const auto origins = formats::readNodeOrigins(value);
  std::vector<std::vector<formats::Vec3f>> points(tree.nodeCount());
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node) {
    const bool hasPoints =
        value.points && value.points->offset[node] < value.points->offset[node + 1];
    if (origins[node] == formats::NodeOrigin::Measured || hasPoints) continue;
    const std::vector<std::uint32_t> near = neighbours.within(node, kNearEdges);
    const Vector3d centre = toEigen(tree.centre[node]);
    const auto [u, v] = planeBasis(toEigen(tree.direction[node]));
    for (std::size_t i = 0; i < fitting::kRingSize; ++i) {
      const Vector3d p = centre + double{tree.radius[node]} * fitting::ringDirection(i, u, v);
      const bool isOpen = std::any_of(near.begin(), near.end(), [&](std::uint32_t other) {
        return tree.branch[other] != tree.branch[node] &&
               (p - toEigen(tree.centre[other])).norm() < double{tree.radius[other]};
      });
      if (!isOpen) points[node].push_back(toVec3f(p));
    }
  }
  return points;
}

}  // namespace lumen::convert
