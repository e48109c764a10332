// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/known_tracks.h"

#include <utility>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

TrackedNode nodeOf(const formats::Case& value, const std::vector<formats::NodeOrigin>& origins,
                   std::uint32_t i) {
  const formats::CenterlineTree& tree = value.tree;
  TrackedNode node;
  node.origin = origins[i];
  node.centre = toEigen(tree.centre[i]);
  node.direction = toEigen(tree.direction[i]).normalized();
  node.radius = double{tree.radius[i]};
  node.height = double{tree.height[i]};
  node.inlierRate = tree.inlierRate.empty() ? 0 : double{tree.inlierRate[i]};
  if (value.points) {
    const auto first = value.points->position.begin();
    const auto& offset = value.points->offset;
    node.points.assign(first + offset[i], first + offset[i + 1]);
  }
  return node;
}

}  // namespace

KnownTracks::KnownTracks(const formats::Case& value) {
  const formats::CenterlineTree& tree = value.tree;
  const auto origins = formats::nodeOriginsOf(value);
  for (const formats::Branch& record : tree.branches) {
    SeedBranch seed;
    seed.label = record.label;
    seed.kind = record.kind;
    TrackedBranch branch;
    branch.stopReason = record.stopReason;
    if (record.parentNode != formats::kNoParent) {
      const auto above = static_cast<std::size_t>(record.parentNode);
      const std::uint32_t parent = tree.branch[above];
      branch.parentBranch = static_cast<int>(parent);
      branch.parentNode = static_cast<int>(above - tree.branches[parent].firstNode);
      seed.parent = tree.branches[parent].label;
    }
    for (std::uint32_t i = 0; i < record.nodeCount; ++i)
      branch.nodes.push_back(nodeOf(value, origins, record.firstNode + i));
    seed.points.push_back({branch.nodes.front().centre, std::nullopt});
    seeds.push_back(std::move(seed));
    branches.push_back(std::move(branch));
  }
}

}  // namespace lumen::convert
