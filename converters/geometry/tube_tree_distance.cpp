// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/tube_tree_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "converters/base/vectors.h"

namespace lumen {

RoundCone::RoundCone(const Eigen::Vector3d& a, double radiusA, const Eigen::Vector3d& b,
                     double radiusB)
    : m_a(a), m_axis(b - a), m_length(m_axis.norm()), m_radiusA(radiusA), m_radiusB(radiusB) {
  if (m_length <= std::abs(radiusA - radiusB)) {
    // one sphere contains the other, and is the whole cone
    m_soleEnd = radiusB > radiusA ? 1 : 0;
    if (radiusB > radiusA) m_a = b;
    m_radiusA = m_radiusB = std::max(radiusA, radiusB);
    m_axis.setZero();
    m_length = m_sine = m_tangent = 0;
    m_cosine = 1;
    return;
  }
  m_axis /= m_length;
  m_sine = (radiusA - radiusB) / m_length;
  m_cosine = std::sqrt((1 - m_sine) * (1 + m_sine));
  m_tangent = m_sine / m_cosine;
}

double RoundCone::distance(const Eigen::Vector3d& point, double* along) const {
  const Eigen::Vector3d v = point - m_a;
  const double x = v.dot(m_axis);
  const double y = std::sqrt(std::max(0.0, v.squaredNorm() - x * x));
  // the foot of the surface's normal on the axis
  const double foot = x - y * m_tangent;
  if (along) *along = m_length > 0 ? std::clamp(foot / m_length, 0.0, 1.0) : m_soleEnd;
  if (foot <= 0 || m_length == 0) return v.norm() - m_radiusA;
  if (foot >= m_length) return std::sqrt((x - m_length) * (x - m_length) + y * y) - m_radiusB;
  return m_sine * x + m_cosine * y - m_radiusA;
}

TubeTreeDistance::TubeTreeDistance(const formats::CenterlineTree& tree) {
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) addBranch(tree, b);
  build(tree);
}

TubeTreeDistance::TubeTreeDistance(const formats::CenterlineTree& tree, std::uint32_t branch) {
  addBranch(tree, branch);
  build(tree);
}

void TubeTreeDistance::addBranch(const formats::CenterlineTree& tree, std::uint32_t branch) {
  const formats::Branch& b = tree.branches[branch];
  const std::uint32_t last = b.firstNode + b.nodeCount;
  for (std::uint32_t n = b.firstNode; n + 1 < last || (n < last && b.nodeCount == 1); ++n) {
    const std::uint32_t next = std::min(n + 1, last - 1);
    m_segments.push_back(
        {RoundCone(toEigen(tree.centre[n]), static_cast<double>(tree.radius[n]),
                   toEigen(tree.centre[next]), static_cast<double>(tree.radius[next])),
         branch, n});
  }
}

void TubeTreeDistance::build(const formats::CenterlineTree& tree) {
  std::vector<convert::Box3d> boxes(m_segments.size());
  std::vector<double> radius(m_segments.size(), 0);
  for (std::size_t s = 0; s < boxes.size(); ++s) {
    const std::uint32_t node = m_segments[s].node;
    const formats::Branch& branch = tree.branches[m_segments[s].branch];
    const std::uint32_t next = std::min(node + 1, branch.firstNode + branch.nodeCount - 1);
    for (const std::uint32_t end : {node, next}) {
      boxes[s].add(toEigen(tree.centre[end]));
      radius[s] = std::max(radius[s], static_cast<double>(tree.radius[end]));
    }
  }
  // segments follow their branch, so runs of them are compact without sorting
  m_tree = Tree(boxes);
  m_maxRadius.assign(m_tree.nodes().size(), 0);
  for (auto i = static_cast<std::uint32_t>(m_maxRadius.size()); i-- > 0;) {
    const Tree::Node& node = m_tree.node(i);
    if (node.count == 0) m_maxRadius[i] = std::max(m_maxRadius[i + 1], m_maxRadius[node.at]);
    for (std::uint32_t s = node.at; s < node.at + node.count; ++s)
      m_maxRadius[i] = std::max(m_maxRadius[i], radius[s]);
  }
}

double TubeTreeDistance::leastDistance(std::uint32_t node, const Eigen::Vector3d& point) const {
  return m_tree.node(node).box.gap(point).norm() - m_maxRadius[node];
}

WallHit TubeTreeDistance::nearest(const Eigen::Vector3d& point) const {
  WallHit hit;
  struct Entry {
    std::uint32_t node;
    double bound;
  };
  std::array<Entry, Tree::kDeepest> stack;
  std::size_t depth = 0;
  const auto push = [&](std::uint32_t node) {
    stack[depth++] = {node, leastDistance(node, point)};
  };
  if (!m_segments.empty()) push(0);
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.bound > hit.distance) continue;
    const Tree::Node& node = m_tree.node(entry.node);
    if (node.count == 0) {
      // the nearer child is visited first
      push(node.at);
      push(entry.node + 1);
      if (stack[depth - 1].bound > stack[depth - 2].bound)
        std::swap(stack[depth - 1], stack[depth - 2]);
      continue;
    }
    for (std::uint32_t s = node.at; s < node.at + node.count; ++s) lower(s, point, hit);
  }
  return hit;
}

void TubeTreeDistance::lower(std::uint32_t segment, const Eigen::Vector3d& point,
                             WallHit& hit) const {
  const Segment& s = m_segments[segment];
  double along = 0;
  const double distance = s.cone.distance(point, &along);
  if (distance < hit.distance || (distance == hit.distance && s.node < hit.node))
    hit = {distance, s.branch, s.node, along};
}

void TubeTreeDistance::collect(const Eigen::Vector3d& centre, double reach,
                               std::vector<std::uint32_t>& segments) const {
  segments.clear();
  if (m_segments.empty()) return;
  // a distance changes by at most the displacement of its point
  const double limit = nearest(centre).distance + 2 * reach;
  std::array<std::uint32_t, Tree::kDeepest> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Tree::Node& node = m_tree.node(index);
    if (leastDistance(index, centre) > limit) continue;
    if (node.count == 0) {
      stack[depth++] = node.at;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::uint32_t s = node.at; s < node.at + node.count; ++s)
      if (m_segments[s].cone.distance(centre) <= limit) segments.push_back(s);
  }
}

WallHit TubeTreeDistance::nearestAmong(std::span<const std::uint32_t> segments,
                                       const Eigen::Vector3d& point) const {
  WallHit hit;
  for (const std::uint32_t s : segments) lower(s, point, hit);
  return hit;
}

}  // namespace lumen
