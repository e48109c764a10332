// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/measure/exact_design.h"

#include <algorithm>

#include "converters/base/vectors.h"
#include "converters/geometry/icosphere.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/fitting/fit.h"

namespace lumen::convert::test {

using Eigen::Vector3d;

namespace {

constexpr double kFarthest = 2.4;  // radii

// Distance along a ray from inside to the wall, mm.
double reach(const TubeTreeDistance& wall, const Vector3d& from, const Vector3d& along) {
  double t = 0;
  for (int i = 0; i < 200; ++i) {
    const double depth = -wall.nearest(from + t * along).distance;
    if (depth < 1e-6) break;
    t += depth;
  }
  return t;
}

}  // namespace

formats::Case caseOfDesign(const Design& design, double spacing, double voxel) {
  const formats::CenterlineTree& all = design.tree;
  const TubeTreeDistance wall(all);
  formats::Case value;
  value.metadata.voxelSize = voxel;
  formats::CenterlineTree& tree = value.tree;
  std::vector<std::int32_t> kept(all.nodeCount(), formats::kNoParent);
  for (std::uint32_t b = 0; b < all.branches.size(); ++b) {
    formats::Branch branch = all.branches[b];
    const std::uint32_t first = branch.firstNode, last = first + branch.nodeCount - 1;
    branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
    std::int32_t before = branch.parentNode == formats::kNoParent
                              ? formats::kNoParent
                              : kept[static_cast<std::size_t>(branch.parentNode)];
    branch.parentNode = before;
    double since = 1e9, widest = 0;
    for (std::uint32_t n = first; n <= last; ++n)
      widest = std::max(widest, static_cast<double>(all.radius[n]));
    for (std::uint32_t n = first; n <= last; ++n) {
      // centres of a sac lie beyond its neck
      if (branch.kind == formats::BranchKind::Aneurysm &&
          static_cast<double>(all.radius[n]) < 0.75 * widest)
        continue;
      since += static_cast<double>(all.height[n]);
      if (since >= spacing * static_cast<double>(all.radius[n]) || n == last) {
        since = 0;
        tree.parent.push_back(before);
        before = static_cast<std::int32_t>(tree.nodeCount());
        tree.centre.push_back(all.centre[n]);
        tree.direction.push_back(all.direction[n]);
        tree.radius.push_back(all.radius[n]);
        tree.height.push_back(static_cast<float>(spacing) * all.radius[n]);
        tree.branch.push_back(b);
      }
      kept[n] = before;
    }
    branch.nodeCount = static_cast<std::uint32_t>(tree.nodeCount()) - branch.firstNode;
    tree.branches.push_back(branch);
  }
  value.points.emplace().offset.push_back(0);
  const std::vector<Vector3d> rays = icosphere(3);
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    for (const Vector3d& ray : rays) {
      const double t = reach(wall, toEigen(tree.centre[n]), ray);
      // a wall of another branch is seen through the neck
      if (wall.nearest(toEigen(tree.centre[n]) + t * ray).branch == tree.branch[n] &&
          t < kFarthest * static_cast<double>(tree.radius[n]))
        value.points->position.push_back(toVec3f(toEigen(tree.centre[n]) + t * ray));
    }
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  FitOptions options;
  Progress progress;
  fit(value, options, progress);
  return value;
}

}  // namespace lumen::convert::test
