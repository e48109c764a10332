// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/vessel_values.h"

#include <algorithm>
#include <cstddef>

#include "converters/base/vectors.h"

namespace lumen::convert {

VesselValues vesselAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                      const Eigen::Vector3d& point, std::uint32_t node) {
  const Eigen::Vector3d from = toEigen(tree.centre[node]);
  double nearest = (point - from).squaredNorm(), share = 0;
  std::uint32_t other = node;
  for (const std::uint32_t neighbour : edges.of(node)) {
    const Eigen::Vector3d along = toEigen(tree.centre[neighbour]) - from;
    const double squared = along.squaredNorm();
    if (!(squared > 0)) continue;
    const double t = std::clamp((point - from).dot(along) / squared, 0.0, 1.0);
    const double distance = (point - from - t * along).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    share = t;
    other = neighbour;
  }
  const auto between = [&](const auto& values) {
    return static_cast<float>((1 - share) * double(values[node]) + share * double(values[other]));
  };
  VesselValues result{between(tree.radius), {}};
  if (!tree.inlierRate.empty()) result.confidence = between(tree.inlierRate);
  return result;
}

}  // namespace lumen::convert
