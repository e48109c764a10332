// SPDX-License-Identifier: Apache-2.0
// The clicks on a tree that came from a file: one for each vessel that is large enough; declared in
// design.h.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kShortest = 5;       // mm
constexpr double kNarrowest = 1.5;    // voxels
constexpr double kOffAxis = 0.2;      // radii
constexpr double kBeyondWall = 1.5;   // of the child's own radii, of a careless click
constexpr double kFarthestStart = 4;  // radii of the parent, along the vessel
constexpr double kRadiusAccuracy = 0.09;

double radiusAt(const formats::CenterlineTree& tree, std::uint32_t node) {
  return static_cast<double>(tree.radius[node]);
}

double stepOf(const formats::CenterlineTree& tree, const formats::Branch& branch) {
  return static_cast<double>(tree.height[branch.firstNode]);
}

bool isLarge(const formats::CenterlineTree& tree, const formats::Branch& branch, double voxel) {
  if (stepOf(tree, branch) * (branch.nodeCount - 1.0) <= kShortest) return false;
  std::vector<float> radii(tree.radius.begin() + branch.firstNode,
                           tree.radius.begin() + branch.firstNode + branch.nodeCount);
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return static_cast<double>(*middle) >= kNarrowest * voxel;
}

// The node of the nearest kept ancestor to which the branch is joined, directly or by others, or
// kNoParent.
std::int32_t keptParent(const formats::CenterlineTree& tree, const formats::Branch& branch,
                        const std::vector<bool>& kept) {
  std::int32_t node = branch.parentNode;
  while (node != formats::kNoParent && !kept[tree.branch[static_cast<std::size_t>(node)]])
    node = tree.branches[tree.branch[static_cast<std::size_t>(node)]].parentNode;
  return node;
}

// The first node that is `away` mm from the axis of the parent, or the last within
// `kFarthestStart` times `parentRadius` along the branch.
std::uint32_t firstNodeAway(const formats::CenterlineTree& tree, const formats::Branch& branch,
                            const formats::Branch& parent, double away, double parentRadius) {
  const auto farthest =
      branch.firstNode +
      static_cast<std::uint32_t>(
          std::min(branch.nodeCount - 1.0, kFarthestStart * parentRadius / stepOf(tree, branch)));
  const auto isClear = [&](std::uint32_t node) {
    for (std::uint32_t n = parent.firstNode; n < parent.firstNode + parent.nodeCount; ++n)
      if ((nodeCentre(tree, n) - nodeCentre(tree, node)).norm() < away) return false;
    return true;
  };
  std::uint32_t node = branch.firstNode;
  while (node < farthest && !isClear(node)) ++node;
  return node;
}

Vector3d clickAt(const formats::CenterlineTree& tree, std::uint32_t node, Random& random) {
  const auto [u, v] = perpendiculars(nodeDirection(tree, node));
  const double angle = 2 * std::numbers::pi * random.uniform();
  return nodeCentre(tree, node) +
         kOffAxis * radiusAt(tree, node) * (std::cos(angle) * u + std::sin(angle) * v);
}

double estimate(double value, Random& random) {
  return value * random.uniform(1 - kRadiusAccuracy, 1 + kRadiusAccuracy);
}

SeedBranch click(const formats::CenterlineTree& tree, const formats::Branch& branch,
                 std::int32_t keptNode, Random& random) {
  SeedBranch seed;
  seed.label = branch.label;
  if (keptNode == formats::kNoParent) {
    const double along = 0.5 * radiusAt(tree, branch.firstNode) / stepOf(tree, branch);
    const auto node = branch.firstNode + static_cast<std::uint32_t>(
                                             std::min(branch.nodeCount - 1.0, std::round(along)));
    seed.points.push_back({clickAt(tree, node, random), estimate(radiusAt(tree, node), random)});
    seed.direction = nodeDirection(tree, node);
    return seed;
  }
  const auto parentNode = static_cast<std::uint32_t>(branch.parentNode);
  const double parentRadius = radiusAt(tree, parentNode);
  const std::uint32_t node = firstNodeAway(tree, branch, tree.branches[tree.branch[parentNode]],
                                           random.uniform(1.5, 1.75) * parentRadius, parentRadius);
  seed.points.push_back({clickAt(tree, node, random), std::nullopt});
  const auto kept = static_cast<std::uint32_t>(keptNode);
  if (radiusAt(tree, node) < 0.5 * radiusAt(tree, kept))
    seed.points[0].radius = estimate(radiusAt(tree, node), random);
  seed.parent = tree.branches[tree.branch[kept]].label;
  return seed;
}

/// The first node that is 1.5 of its own radii beyond the wall of the parent, or the last within
/// `kFarthestStart` of the parent's radii along the branch.
std::uint32_t beyondWall(const formats::CenterlineTree& tree, const formats::Branch& branch) {
  const auto at = static_cast<std::uint32_t>(branch.parentNode);
  const formats::Branch& parent = tree.branches[tree.branch[at]];
  const auto isBeyond = [&](std::uint32_t node) {
    for (std::uint32_t n = parent.firstNode; n < parent.firstNode + parent.nodeCount; ++n)
      if ((nodeCentre(tree, n) - nodeCentre(tree, node)).norm() <
          radiusAt(tree, n) + kBeyondWall * radiusAt(tree, node))
        return false;
    return true;
  };
  const double farthest = kFarthestStart * radiusAt(tree, at) / stepOf(tree, branch);
  const auto last =
      branch.firstNode + static_cast<std::uint32_t>(std::min(branch.nodeCount - 1.0, farthest));
  std::uint32_t node = branch.firstNode;
  while (node < last && !isBeyond(node)) ++node;
  return node;
}

SeedBranch carelessClick(const formats::CenterlineTree& tree, const formats::Branch& branch,
                         std::int32_t keptNode, Random& random) {
  SeedBranch seed;
  seed.label = branch.label;
  const bool isRoot = keptNode == formats::kNoParent;
  const std::uint32_t node =
      branch.parentNode == formats::kNoParent ? branch.firstNode : beyondWall(tree, branch);
  seed.points.push_back({clickAt(tree, node, random), std::nullopt});
  if (!isRoot) seed.parent = tree.branches[tree.branch[static_cast<std::uint32_t>(keptNode)]].label;
  return seed;
}

}  // namespace

std::vector<SeedBranch> clickCarelessly(const formats::CenterlineTree& tree, double voxel,
                                        Random& random) {
  std::vector<bool> kept;
  std::vector<SeedBranch> seeds;
  for (const formats::Branch& branch : tree.branches) {
    kept.push_back(branch.kind == formats::BranchKind::Vessel && isLarge(tree, branch, voxel));
    if (kept.back())
      seeds.push_back(carelessClick(tree, branch, keptParent(tree, branch, kept), random));
  }
  for (SeedBranch& seed : clickSeeds(tree, random)) {
    if (seed.kind == formats::BranchKind::Vessel) continue;
    const auto isParent = [&](const SeedBranch& other) { return other.label == seed.parent; };
    if (std::none_of(seeds.begin(), seeds.end(), isParent)) seed.parent.reset();
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

std::vector<SeedBranch> clickLargeVessels(const formats::CenterlineTree& tree, double voxel,
                                          Random& random) {
  std::vector<bool> kept;
  std::vector<SeedBranch> seeds;
  for (const formats::Branch& branch : tree.branches) {
    kept.push_back(isLarge(tree, branch, voxel));
    if (kept.back()) seeds.push_back(click(tree, branch, keptParent(tree, branch, kept), random));
  }
  return seeds;
}

}  // namespace lumen::convert
