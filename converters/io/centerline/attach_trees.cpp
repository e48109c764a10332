// SPDX-License-Identifier: Apache-2.0
// Trees and parts that begin in the lumen of others; declared in line_graph.h.
#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "converters/geometry/disjoint_sets.h"
#include "converters/io/centerline/line_graph.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Index = std::int32_t;

// Least lumen of a segment, relative to its length and to its coordinates: rounding.
constexpr double kLeastOfStep = 1e-3, kLeastOfPlace = 1e-12;

std::size_t slot(Index index) {
  return static_cast<std::size_t>(index);
}

// The tree of each point, numbered by roots.
std::vector<Index> treesOf(const CenterlineFile& file, std::vector<Index>& roots) {
  std::vector<Index> tree(file.points.size());
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const Index parent = file.points[i].parent;
    if (parent == kNoPoint) roots.push_back(static_cast<Index>(i));
    tree[i] = parent == kNoPoint ? static_cast<Index>(roots.size()) - 1 : tree[slot(parent)];
  }
  return tree;
}

}  // namespace

AxisSearch::AxisSearch(const std::vector<CenterlinePoint>& points,
                       const std::vector<std::array<Index, 2>>& segments,
                       const std::vector<Index>& partOf)
    : m_points(points) {
  for (const auto& [a, b] : segments) {
    const std::size_t part = slot(partOf[slot(a)]);
    if (part >= m_parts.size()) m_parts.resize(part + 1);
    const CenterlinePoint &p = points[slot(a)], &q = points[slot(b)];
    const double reach =
        std::max({p.radius, q.radius, kLeastOfStep * (p.position - q.position).norm()});
    const Vector3d low = (p.position.cwiseMin(q.position).array() - reach).matrix();
    const Vector3d high = (p.position.cwiseMax(q.position).array() + reach).matrix();
    Part& owner = m_parts[part];
    owner.low = owner.segments.empty() ? low : owner.low.cwiseMin(low);
    owner.high = owner.segments.empty() ? high : owner.high.cwiseMax(high);
    owner.segments.push_back({a, b});
  }
}

AxisContact AxisSearch::nearest(Index point, Index self) const {
  const Vector3d& p = m_points[slot(point)].position;
  AxisContact best{kNoPoint, 1};
  for (std::size_t part = 0; part < m_parts.size(); ++part) {
    const Part& other = m_parts[part];
    if (part == slot(self) || other.segments.empty() || (p.array() < other.low.array()).any() ||
        (p.array() > other.high.array()).any())
      continue;
    for (const auto& [a, b] : other.segments) {
      const Vector3d& from = m_points[slot(a)].position;
      const Vector3d along = m_points[slot(b)].position - from;
      const double length = along.norm();
      const double share =
          length > 0 ? std::clamp((p - from).dot(along) / (length * length), 0.0, 1.0) : 0;
      const double radius = std::max({m_points[slot(a)].radius, m_points[slot(b)].radius,
                                      kLeastOfStep * length, kLeastOfPlace * p.norm(), 1e-300});
      const double distance = (p - from - share * along).norm() / radius;
      if (distance < best.distance) best = {share < 0.5 ? a : b, distance};
    }
  }
  return best;
}

void orderParentsFirst(CenterlineFile& file) {
  const std::size_t count = file.points.size();
  std::vector<std::vector<Index>> children(count);
  std::priority_queue<Index, std::vector<Index>, std::greater<>> ready;
  for (std::size_t i = 0; i < count; ++i) {
    const Index parent = file.points[i].parent;
    if (parent == kNoPoint)
      ready.push(static_cast<Index>(i));
    else
      children[slot(parent)].push_back(static_cast<Index>(i));
  }
  std::vector<Index> place(count, kNoPoint);
  std::vector<CenterlinePoint> ordered;
  while (!ready.empty()) {
    const Index next = ready.top();
    ready.pop();
    place[slot(next)] = static_cast<Index>(ordered.size());
    ordered.push_back(file.points[slot(next)]);
    if (ordered.back().parent != kNoPoint)
      ordered.back().parent = place[slot(ordered.back().parent)];
    for (const Index child : children[slot(next)]) ready.push(child);
  }
  for (auto& [a, b] : file.links) {
    const auto [low, high] = std::minmax(place[slot(a)], place[slot(b)]);
    std::tie(a, b) = std::tuple(low, high);
  }
  file.points = std::move(ordered);
}

void attachTrees(CenterlineFile& file) {
  std::vector<Index> roots;
  const std::vector<Index> tree = treesOf(file, roots);
  if (roots.size() < 2 || roots.size() > kMostParts) return;
  std::vector<std::array<Index, 2>> segments;
  std::vector<std::size_t> size(roots.size(), 0);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    ++size[slot(tree[i])];
    const Index parent = file.points[i].parent;
    if (parent != kNoPoint) segments.push_back({parent, static_cast<Index>(i)});
  }
  const AxisSearch search(file.points, segments, tree);
  // the nearest first; of two roots at one place the smaller tree is attached
  std::vector<std::tuple<double, std::size_t, Index, Index>> joints;
  for (std::size_t t = 0; t < roots.size(); ++t) {
    const AxisContact contact = search.nearest(roots[t], static_cast<Index>(t));
    if (contact.point != kNoPoint)
      joints.emplace_back(contact.distance, size[t], roots[t], contact.point);
  }
  std::sort(joints.begin(), joints.end());
  DisjointSets joined(roots.size());
  std::size_t attached = 0;
  for (const auto& [distance, points, root, on] : joints) {
    const auto a = static_cast<std::uint32_t>(tree[slot(root)]);
    const auto b = static_cast<std::uint32_t>(tree[slot(on)]);
    if (joined.find(a) == joined.find(b)) continue;
    joined.join(a, b);
    file.points[slot(root)].parent = on;
    ++attached;
  }
  if (attached == 0) return;
  orderParentsFirst(file);
  file.remarks.push_back(std::to_string(attached) + " of " + std::to_string(roots.size()) +
                         " trees begin in the lumen of another tree, and are attached to it");
}

}  // namespace lumen::convert
