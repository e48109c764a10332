// SPDX-License-Identifier: Apache-2.0
// Where a child hangs on its parent, by tracks that are given (docs/method.md, section 1.12).
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/joining.h"
#include "seeded_tubes.h"

namespace lumen::convert {
namespace {

/// A node with twelve points on its wall.
TrackedNode nodeAt(const Vector3d& centre, const Vector3d& direction, double radius) {
  TrackedNode node;
  node.centre = centre;
  node.direction = direction;
  node.radius = radius;
  node.height = 0.4;
  const auto [e1, e2] = planeBasis(direction);
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.5235987755982988 * i;
    const Vector3d p = centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    node.points.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return node;
}

/// Nodes along z, upward or downward.
TrackedBranch alongZ(double x, double from, double to, double radius) {
  TrackedBranch branch;
  const Vector3d direction = from < to ? Vector3d::UnitZ() : Vector3d(-Vector3d::UnitZ());
  const int count = static_cast<int>(std::abs(to - from) / 0.4) + 1;
  for (int i = 0; i < count; ++i)
    branch.nodes.push_back(nodeAt({x, 6.4, from + 0.4 * i * direction.z()}, direction, radius));
  return branch;
}

// A child beside its parent, with dark tissue between the two, that leaves it 4 mm farther up.
TEST(JoinToParent, TheParentsNodeIsWhereTheLumenLeadsNotTheNearestInAStraightLine) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min({capsule(p, kLow, kHigh, 1.0), capsule(p, {9, 6.4, 0.4}, {9, 6.4, 7}, 0.6),
                     capsule(p, {9, 6.4, 7}, {6.4, 6.4, 7}, 0.6)});
  });
  const BsplineVolume spline(volume);
  const TrackOptions options;
  Progress silent;
  const TrackContext context(spline, options, 0, silent);
  std::vector<TrackedBranch> all{alongZ(6.4, 0.6, 12, 1.0), alongZ(9, 3, 1, 0.6)};
  all[1].parentBranch = 0;
  TrackRun run(context, Random(3));
  TrackedBranch child = all[1];
  joinToParent(run, all, {}, child);
  ASSERT_EQ(child.parentBranch, 0);
  ASSERT_GE(child.parentNode, 0);
  EXPECT_NEAR(all[0].nodes[static_cast<std::size_t>(child.parentNode)].centre.z(), 7.0, 0.8);
  EXPECT_GT(child.nodes.front().centre.z(), 6.0);
  EXPECT_LT(child.nodes.front().centre.x(), 8.0) << "the first node leaves the parent";
}

}  // namespace
}  // namespace lumen::convert
