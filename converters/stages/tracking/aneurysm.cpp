// SPDX-License-Identifier: Apache-2.0
// Declared in sac_walls.h.
#include <algorithm>
#include <utility>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/sac_walls.h"

namespace lumen::convert {

using Eigen::Vector3d;

std::optional<TrackedNode> sacNodeAt(TrackRun& run, const SeedPoint& click) {
  Candidates& points = run.workspace.candidates;
  run.workspace.caster.cast(click.position, kRayRadii * click.radius.value(), points);
  if (points.count() == 0) return std::nullopt;
  const float strongest = *std::max_element(points.strength.begin(), points.strength.end());
  TrackedNode node;
  node.centre = click.position;
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.count(); ++i) {
    if (points.strength[i] < run.context.options.aneurysmGradient * strongest) continue;
    node.points.push_back(toVec3f(points.origin + points.offset(i)));
    distances.push_back(points.offset(i).norm());
  }
  node.radius = median(std::move(distances));
  node.inlierRate =
      static_cast<double>(node.points.size()) / static_cast<double>(run.context.rays.size());
  return node;
}

void alignWithChain(std::vector<TrackedNode>& nodes) {
  const std::size_t count = nodes.size();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Vector3d segment = nodes[i + 1].centre - nodes[i].centre;
    nodes[i].height = segment.norm();
    nodes[i].direction = segment.normalized();
  }
  nodes[count - 1].height = nodes[count - 2].height;
  nodes[count - 1].direction = nodes[count - 2].direction;
}

TrackedBranch captureAneurysm(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent) {
  TrackedBranch branch;
  branch.stopReason = formats::StopReason::EndOfSeeds;
  for (const SeedPoint& click : seed.points)
    if (std::optional<TrackedNode> node = sacNodeAt(run, click))
      branch.nodes.push_back(std::move(*node));
  if (branch.nodes.empty()) {
    branch.failure =
        "no ray from its points meets a wall; expected points within the aneurysm, with radii of "
        "about the distance to its wall";
    return branch;
  }
  if (parent && closestOnChain(parent->nodes, branch.nodes.back().centre).distance <
                    closestOnChain(parent->nodes, branch.nodes.front().centre).distance)
    std::reverse(branch.nodes.begin(), branch.nodes.end());
  TrackedNode& first = branch.nodes[0];
  Vector3d alone = seed.direction.value_or(Vector3d::UnitZ());
  if (parent) {
    const ChainPoint root = closestOnChain(parent->nodes, first.centre);
    branch.parentNode = static_cast<int>(root.node);
    alone = (first.centre - root.position).normalized();
  }
  if (branch.nodes.size() == 1) {
    first.direction = alone;
    first.height = first.radius;
  } else {
    alignWithChain(branch.nodes);
  }
  return branch;
}

}  // namespace lumen::convert
