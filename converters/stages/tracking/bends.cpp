// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/bends.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Of the radius: the most that a centre moves. Vessels whose bends ask for more are bent too
/// sharply for a circle to tell by how much.
constexpr double kMostShift = 0.1;

/// Towards the middle of the bend at node `n`, 1/mm; zero where the chain is too short to tell.
Vector3d curvatureAt(const std::vector<TrackedNode>& nodes, std::size_t n) {
  const Vector3d& centre = nodes[n].centre;
  const auto isFar = [&](const TrackedNode& node) {
    return (node.centre - centre).norm() >= nodes[n].height;
  };
  const auto at = nodes.begin() + static_cast<std::ptrdiff_t>(n);
  const auto ahead = std::find_if(at, nodes.end(), isFar);
  const auto behind = std::find_if(std::make_reverse_iterator(at), nodes.rend(), isFar);
  if (ahead == nodes.end() || behind == nodes.rend()) return Vector3d::Zero();
  const Vector3d on = ahead->centre - centre, from = centre - behind->centre;
  return 2.0 / (on.norm() + from.norm()) * (on.normalized() - from.normalized());
}

}  // namespace

void correctBends(std::vector<TrackedNode>& nodes) {
  std::vector<Vector3d> shifts;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Vector3d shift = -0.5 * nodes[n].meanSquareAlong * curvatureAt(nodes, n);
    const double most = kMostShift * nodes[n].radius;
    if (shift.norm() > most) shift *= most / shift.norm();
    shifts.push_back(shift);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n].centre += shifts[n];
}

}  // namespace lumen::convert
