// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/design.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

constexpr int kCurveSamples = 4000;
constexpr double kReferenceExtent = 25.4;  // mm: 128 voxels of 0.2 mm

// The unit direction. Where a path turns back on itself, the direction of its rest; where it stands
// still, the z axis.
Eigen::Vector3d directionAt(const Path& path, std::size_t i) {
  const Eigen::Vector3d& before = path[i == 0 ? 0 : i - 1].position;
  const Eigen::Vector3d& after = path[std::min(i + 1, path.size() - 1)].position;
  if (after != before) return (after - before).normalized();
  if (after != path[i].position) return (after - path[i].position).normalized();
  return Eigen::Vector3d::UnitZ();
}

}  // namespace

double Frame::radiusScale() const {
  return std::clamp(extent / kReferenceExtent, 0.5, 1.5);
}

Path sampleCurve(const std::function<Eigen::Vector3d(double)>& position,
                 const std::function<double(double)>& radius) {
  Path path;
  path.reserve(kCurveSamples + 1);
  for (int i = 0; i <= kCurveSamples; ++i) {
    const double t = static_cast<double>(i) / kCurveSamples;
    path.push_back({position(t), radius(t)});
  }
  return path;
}

Path straightPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  const std::function<double(double)>& radius) {
  return sampleCurve([&](double t) -> Eigen::Vector3d { return from + t * (to - from); }, radius);
}

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

double pathLength(const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].position - path[i - 1].position).norm();
  return length;
}

Path resamplePath(const Path& path, double spacing) {
  const double length = pathLength(path);
  const int steps = std::max(1, static_cast<int>(std::lround(length / spacing)));
  Path even{path.front()};
  double before = 0;
  std::size_t segment = 1;
  for (int i = 1; i < steps; ++i) {
    const double wanted = length * i / steps;
    double piece = (path[segment].position - path[segment - 1].position).norm();
    while (segment + 1 < path.size() && before + piece < wanted) {
      before += piece;
      ++segment;
      piece = (path[segment].position - path[segment - 1].position).norm();
    }
    const double u = piece > 0 ? std::min(1.0, (wanted - before) / piece) : 0.0;
    const PathPoint &a = path[segment - 1], &b = path[segment];
    even.push_back(
        {a.position + u * (b.position - a.position), a.radius + u * (b.radius - a.radius)});
  }
  even.push_back(path.back());
  return even;
}

std::int32_t TreeBuilder::nearestNode(std::uint32_t branch, const Eigen::Vector3d& point) const {
  const formats::Branch& b = tree().branches[branch];
  std::uint32_t best = b.firstNode;
  for (std::uint32_t n = b.firstNode; n < b.firstNode + b.nodeCount; ++n)
    if ((toEigen(tree().centre[n]) - point).squaredNorm() <
        (toEigen(tree().centre[best]) - point).squaredNorm())
      best = n;
  return static_cast<std::int32_t>(best);
}

std::uint32_t TreeBuilder::add(const std::string& label, std::int32_t parent, const Path& path,
                               formats::BranchKind kind) {
  const Path even = resamplePath(path, m_frame.nodeSpacing());
  formats::CenterlineTree& tree = m_design.tree;
  const auto index = static_cast<std::uint32_t>(tree.branches.size());
  const auto first = static_cast<std::uint32_t>(tree.nodeCount());
  formats::Branch branch;
  branch.label = label;
  branch.kind = kind;
  branch.parentNode = parent == formats::kNoParent
                          ? formats::kNoParent
                          : nearestNode(static_cast<std::uint32_t>(parent), even.front().position);
  branch.firstNode = first;
  branch.nodeCount = static_cast<std::uint32_t>(even.size());
  tree.branches.push_back(branch);
  const double height = pathLength(even) / static_cast<double>(even.size() - 1);
  for (std::size_t i = 0; i < even.size(); ++i) {
    tree.centre.push_back(toVec3f(even[i].position));
    tree.direction.push_back(toVec3f(directionAt(even, i)));
    tree.radius.push_back(static_cast<float>(even[i].radius));
    tree.height.push_back(static_cast<float>(height));
    tree.parent.push_back(i == 0 ? branch.parentNode : static_cast<std::int32_t>(first + i) - 1);
    tree.branch.push_back(index);
    m_design.contrast.push_back(1.0F);
  }
  return index;
}

void TreeBuilder::link(std::uint32_t from, std::uint32_t to) {
  formats::CenterlineTree& tree = m_design.tree;
  const formats::Branch& branch = tree.branches[from];
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  const auto other = static_cast<std::uint32_t>(nearestNode(to, toEigen(tree.centre[last])));
  tree.links.push_back({std::min(last, other), std::max(last, other)});
  std::sort(tree.links.begin(), tree.links.end());
}

void fadeContrast(Design& design, double share) {
  const formats::CenterlineTree& tree = design.tree;
  std::vector<double> fromRoot;
  double farthest = 0;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const auto parent = static_cast<std::uint32_t>(tree.parent[n]);
    fromRoot.push_back(tree.parent[n] == formats::kNoParent
                           ? 0
                           : fromRoot[parent] +
                                 (toEigen(tree.centre[n]) - toEigen(tree.centre[parent])).norm());
    farthest = std::max(farthest, fromRoot.back());
  }
  if (share == 0 || farthest == 0) return;
  for (std::size_t n = 0; n < fromRoot.size(); ++n)
    design.contrast[n] *= static_cast<float>(1 - share * fromRoot[n] / farthest);
}

double radiusOf(const formats::CenterlineTree& tree, std::uint32_t node) {
  return static_cast<double>(tree.radius[node]);
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> perpendiculars(const Eigen::Vector3d& w) {
  const Eigen::Vector3d other =
      std::abs(w.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d u = w.cross(other).normalized();
  return {u, w.cross(u)};
}

Eigen::Vector3d randomInCube(Random& random) {
  Eigen::Vector3d v;
  for (double& coordinate : v) coordinate = random.uniform(-1, 1);
  return v;
}

}  // namespace lumen::convert
