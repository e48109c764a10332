// SPDX-License-Identifier: Apache-2.0
// The clicks of a user, on phantoms and on trees of files; declared in design.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Clicks on a tree of a file, and careless ones.
constexpr double kShortest = 5;       // mm
constexpr double kNarrowest = 1.5;    // voxels
constexpr double kOffAxis = 0.2;      // radii
constexpr double kBeyondWall = 1.5;   // of the child's own radii, of a careless click
constexpr double kFarthestStart = 4;  // radii of the parent, along the vessel

// The node at arc length `s` from the start of the branch; nodes are evenly spaced.
std::uint32_t nodeAt(const formats::CenterlineTree& tree, const formats::Branch& branch, double s) {
  const double height = static_cast<double>(tree.height[branch.firstNode]);
  const double index = std::clamp(std::round(s / height), 0.0, branch.nodeCount - 1.0);
  return branch.firstNode + static_cast<std::uint32_t>(index);
}

// A point at most `reach` off the axis at `node`, uniform over the disc.
Vector3d besideAxis(const formats::CenterlineTree& tree, std::uint32_t node, double reach,
                    Random& random) {
  const auto [u, v] = perpendiculars(toEigen(tree.direction[node]));
  const double r = reach * std::sqrt(random.uniform());
  const double angle = 2 * std::numbers::pi * random.uniform();
  return toEigen(tree.centre[node]) + r * (std::cos(angle) * u + std::sin(angle) * v);
}

double about(double value, Random& random) {
  return value * random.uniform(0.91, 1.09);
}

SeedBranch clickRoot(const formats::CenterlineTree& tree, const formats::Branch& branch,
                     Random& random) {
  const std::uint32_t node = nodeAt(tree, branch, 0.5 * radiusOf(tree, branch.firstNode));
  SeedBranch seed;
  seed.points.push_back({besideAxis(tree, node, 0.1 * radiusOf(tree, node), random),
                         about(radiusOf(tree, node), random)});
  const auto [u, v] = perpendiculars(toEigen(tree.direction[node]));
  const double tilt = std::tan(std::numbers::pi / 18) * random.uniform();
  const double angle = 2 * std::numbers::pi * random.uniform();
  seed.direction =
      (toEigen(tree.direction[node]) + tilt * (std::cos(angle) * u + std::sin(angle) * v))
          .normalized();
  return seed;
}

double distanceToAxis(const formats::CenterlineTree& tree, const formats::Branch& branch,
                      const Vector3d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    best = std::min(best, (toEigen(tree.centre[n]) - point).norm());
  return best;
}

SeedBranch clickChild(const formats::CenterlineTree& tree, const formats::Branch& branch,
                      Random& random) {
  const auto parentNode = static_cast<std::uint32_t>(branch.parentNode);
  const formats::Branch& parent = tree.branches[tree.branch[parentNode]];
  const double parentRadius = radiusOf(tree, parentNode);
  const double wanted = random.uniform(1.5, 1.75) * parentRadius;
  std::uint32_t node = branch.firstNode;
  while (node + 1 < branch.firstNode + branch.nodeCount &&
         distanceToAxis(tree, parent, toEigen(tree.centre[node])) < wanted)
    ++node;
  const double radius = radiusOf(tree, node);
  SeedBranch seed;
  seed.points.push_back({besideAxis(tree, node, 0.25 * radius, random), std::nullopt});
  if (radius < 0.5 * parentRadius) seed.points[0].radius = about(radius, random);
  return seed;
}

SeedBranch clickAneurysm(const formats::CenterlineTree& tree, const formats::Branch& branch,
                         Random& random) {
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  const double sac = radiusOf(tree, last);
  SeedBranch seed;
  for (const double offset : {-0.5, 0.0, 0.35}) {
    const Vector3d point =
        toEigen(tree.centre[last]) + offset * sac * toEigen(tree.direction[last]);
    const Vector3d clicked = point + 0.05 * sac * randomInCube(random);
    seed.points.push_back({clicked, about((1 - std::abs(offset)) * sac, random)});
  }
  return seed;
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

// The first node along the branch that lies off the parent's axis as `isBeyond(distance, parent's
// node, node)` wants from each node there, or the last within `kFarthestStart` times `parentRadius`.
template <class Beyond>
std::uint32_t firstNodeBeyond(const formats::CenterlineTree& tree, const formats::Branch& branch,
                              const formats::Branch& parent, double parentRadius, Beyond isBeyond) {
  const auto farthest =
      branch.firstNode +
      static_cast<std::uint32_t>(
          std::min(branch.nodeCount - 1.0, kFarthestStart * parentRadius / stepOf(tree, branch)));
  const auto isClear = [&](std::uint32_t node) {
    for (std::uint32_t n = parent.firstNode; n < parent.firstNode + parent.nodeCount; ++n)
      if (!isBeyond((toEigen(tree.centre[n]) - toEigen(tree.centre[node])).norm(), n, node))
        return false;
    return true;
  };
  std::uint32_t node = branch.firstNode;
  while (node < farthest && !isClear(node)) ++node;
  return node;
}

Vector3d clickAt(const formats::CenterlineTree& tree, std::uint32_t node, Random& random) {
  const auto [u, v] = perpendiculars(toEigen(tree.direction[node]));
  const double angle = 2 * std::numbers::pi * random.uniform();
  return toEigen(tree.centre[node]) +
         kOffAxis * radiusOf(tree, node) * (std::cos(angle) * u + std::sin(angle) * v);
}

SeedBranch click(const formats::CenterlineTree& tree, const formats::Branch& branch,
                 std::int32_t keptNode, Random& random) {
  SeedBranch seed;
  seed.label = branch.label;
  if (keptNode == formats::kNoParent) {
    const double along = 0.5 * radiusOf(tree, branch.firstNode) / stepOf(tree, branch);
    const auto node = branch.firstNode + static_cast<std::uint32_t>(
                                             std::min(branch.nodeCount - 1.0, std::round(along)));
    seed.points.push_back({clickAt(tree, node, random), about(radiusOf(tree, node), random)});
    seed.direction = toEigen(tree.direction[node]);
    return seed;
  }
  const auto parentNode = static_cast<std::uint32_t>(branch.parentNode);
  const double parentRadius = radiusOf(tree, parentNode);
  const double away = random.uniform(1.5, 1.75) * parentRadius;
  const std::uint32_t node = firstNodeBeyond(
      tree, branch, tree.branches[tree.branch[parentNode]], parentRadius,
      [=](double distance, std::uint32_t, std::uint32_t) { return distance >= away; });
  seed.points.push_back({clickAt(tree, node, random), std::nullopt});
  const auto kept = static_cast<std::uint32_t>(keptNode);
  if (radiusOf(tree, node) < 0.5 * radiusOf(tree, kept))
    seed.points[0].radius = about(radiusOf(tree, node), random);
  seed.parent = tree.branches[tree.branch[kept]].label;
  return seed;
}

// The first node that is `kBeyondWall` of its own radii beyond the wall of the parent.
std::uint32_t beyondWall(const formats::CenterlineTree& tree, const formats::Branch& branch) {
  const auto at = static_cast<std::uint32_t>(branch.parentNode);
  return firstNodeBeyond(tree, branch, tree.branches[tree.branch[at]], radiusOf(tree, at),
                         [&](double distance, std::uint32_t n, std::uint32_t node) {
                           return distance >=
                                  radiusOf(tree, n) + kBeyondWall * radiusOf(tree, node);
                         });
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

std::vector<SeedBranch> clickSeeds(const formats::CenterlineTree& tree, Random& random) {
  std::vector<SeedBranch> seeds;
  for (const formats::Branch& branch : tree.branches) {
    SeedBranch seed;
    if (branch.kind == formats::BranchKind::Aneurysm)
      seed = clickAneurysm(tree, branch, random);
    else if (branch.parentNode == formats::kNoParent)
      seed = clickRoot(tree, branch, random);
    else
      seed = clickChild(tree, branch, random);
    seed.label = branch.label;
    seed.kind = branch.kind;
    if (branch.parentNode != formats::kNoParent) {
      const auto node = static_cast<std::uint32_t>(branch.parentNode);
      seed.parent = tree.branches[tree.branch[node]].label;
    }
    seeds.push_back(seed);
  }
  return seeds;
}

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
