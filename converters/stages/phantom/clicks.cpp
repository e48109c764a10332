// SPDX-License-Identifier: Apache-2.0
// The seeds that a user would click; declared in design.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// The node at arc length `s` from the start of the branch; nodes are evenly spaced.
std::uint32_t nodeAt(const formats::CenterlineTree& tree, const formats::Branch& branch, double s) {
  const double height = static_cast<double>(tree.height[branch.firstNode]);
  const double index = std::clamp(std::round(s / height), 0.0, branch.nodeCount - 1.0);
  return branch.firstNode + static_cast<std::uint32_t>(index);
}

// A point at most `reach` off the axis at `node`, uniform over the disc.
Vector3d besideAxis(const formats::CenterlineTree& tree, std::uint32_t node, double reach,
                    Random& random) {
  const auto [u, v] = perpendiculars(nodeDirection(tree, node));
  const double r = reach * std::sqrt(random.uniform());
  const double angle = 2 * std::numbers::pi * random.uniform();
  return nodeCentre(tree, node) + r * (std::cos(angle) * u + std::sin(angle) * v);
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
  const auto [u, v] = perpendiculars(nodeDirection(tree, node));
  const double tilt = std::tan(std::numbers::pi / 18) * random.uniform();
  const double angle = 2 * std::numbers::pi * random.uniform();
  seed.direction =
      (nodeDirection(tree, node) + tilt * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
  return seed;
}

double distanceToAxis(const formats::CenterlineTree& tree, const formats::Branch& branch,
                      const Vector3d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    best = std::min(best, (nodeCentre(tree, n) - point).norm());
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
         distanceToAxis(tree, parent, nodeCentre(tree, node)) < wanted)
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
    const Vector3d point = nodeCentre(tree, last) + offset * sac * nodeDirection(tree, last);
    const Vector3d clicked = point + 0.05 * sac * randomInCube(random);
    seed.points.push_back({clicked, about((1 - std::abs(offset)) * sac, random)});
  }
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

}  // namespace lumen::convert
