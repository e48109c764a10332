// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/tube_tree_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "converters/base/vectors.h"

namespace lumen {
namespace {

constexpr std::uint32_t kLeafSegments = 4;

double distanceToBox(const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                     const Eigen::Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm();
}

}  // namespace

RoundCone::RoundCone(const Eigen::Vector3d& a, double radiusA, const Eigen::Vector3d& b,
                     double radiusB)
    : m_a(a), m_axis(b - a), m_length(m_axis.norm()), m_radiusA(radiusA), m_radiusB(radiusB) {
  if (m_length <= std::abs(radiusA - radiusB)) {
    // one sphere holds the other, and is all there is
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
  if (!m_segments.empty()) build(tree, 0, static_cast<std::uint32_t>(m_segments.size()));
}

TubeTreeDistance::TubeTreeDistance(const formats::CenterlineTree& tree, std::uint32_t branch) {
  addBranch(tree, branch);
  if (!m_segments.empty()) build(tree, 0, static_cast<std::uint32_t>(m_segments.size()));
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

std::uint32_t TubeTreeDistance::build(const formats::CenterlineTree& tree, std::uint32_t first,
                                      std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(m_boxes.size());
  Box box{toEigen(tree.centre[m_segments[first].node]),
          toEigen(tree.centre[m_segments[first].node]),
          0,
          first,
          last,
          0};
  for (std::uint32_t s = first; s < last; ++s) {
    const std::uint32_t node = m_segments[s].node;
    const formats::Branch& branch = tree.branches[m_segments[s].branch];
    const std::uint32_t next = std::min(node + 1, branch.firstNode + branch.nodeCount - 1);
    for (const std::uint32_t end : {node, next}) {
      box.low = box.low.cwiseMin(toEigen(tree.centre[end]));
      box.high = box.high.cwiseMax(toEigen(tree.centre[end]));
      box.maxRadius = std::max(box.maxRadius, static_cast<double>(tree.radius[end]));
    }
  }
  m_boxes.push_back(box);
  if (last - first > kLeafSegments) {
    // segments follow their branch, so halves of the list are compact without sorting
    const std::uint32_t middle = first + (last - first) / 2;
    build(tree, first, middle);
    m_boxes[index].right = build(tree, middle, last);
  }
  return index;
}

WallHit TubeTreeDistance::nearest(const Eigen::Vector3d& point) const {
  WallHit hit;
  struct Entry {
    std::uint32_t box;
    double bound;
  };
  std::array<Entry, 64> stack;
  std::size_t depth = 0;
  const auto push = [&](std::uint32_t box) {
    const Box& b = m_boxes[box];
    stack[depth++] = {box, distanceToBox(point, b.low, b.high) - b.maxRadius};
  };
  if (!m_boxes.empty()) push(0);
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.bound > hit.distance) continue;
    const Box& box = m_boxes[entry.box];
    if (box.right != 0) {
      // the nearer child is visited first
      push(box.right);
      push(entry.box + 1);
      if (stack[depth - 1].bound > stack[depth - 2].bound)
        std::swap(stack[depth - 1], stack[depth - 2]);
      continue;
    }
    for (std::uint32_t s = box.first; s < box.last; ++s) lower(s, point, hit);
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
  if (m_boxes.empty()) return;
  // distances change by no more than the way that a point moves
  const double limit = nearest(centre).distance + 2 * reach;
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Box& box = m_boxes[index];
    if (distanceToBox(centre, box.low, box.high) - box.maxRadius > limit) continue;
    if (box.right != 0) {
      stack[depth++] = box.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::uint32_t s = box.first; s < box.last; ++s)
      if (m_segments[s].cone.distance(centre) <= limit) segments.push_back(s);
  }
}

WallHit TubeTreeDistance::nearestOf(std::span<const std::uint32_t> segments,
                                    const Eigen::Vector3d& point) const {
  WallHit hit;
  for (const std::uint32_t s : segments) lower(s, point, hit);
  return hit;
}

}  // namespace lumen
