// SPDX-License-Identifier: Apache-2.0
// findTouchingNodes() of separated_field.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "converters/stages/surface/separated_field.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

// Paths longer than this many distances lead round a bend, or through a fork.
constexpr double kDetour = 1.3;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

double distanceOf(const formats::CenterlineTree& tree, std::uint32_t a, std::uint32_t b) {
  const formats::Vec3f &p = tree.centre[a], &q = tree.centre[b];
  return std::hypot(double{p.x} - q.x, double{p.y} - q.y, double{p.z} - q.z);
}

// The nodes by the cubes of space that their reach meets.
class NodeGrid {
public:
  NodeGrid(const formats::CenterlineTree& tree, double edge) : m_tree(tree), m_edge(edge) {
    for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) m_cell[cellOf(i)].push_back(i);
  }

  // All nodes of cells within `reach` mm of a node's own.
  template <class Visit>
  void visitNear(std::uint32_t node, double reach, Visit&& visit) const {
    const Cell c = cellOf(node);
    const auto wide = static_cast<std::int64_t>(std::ceil(reach / m_edge));
    for (std::int64_t x = c[0] - wide; x <= c[0] + wide; ++x)
      for (std::int64_t y = c[1] - wide; y <= c[1] + wide; ++y)
        for (auto at = m_cell.lower_bound({x, y, c[2] - wide});
             at != m_cell.end() && at->first <= Cell{x, y, c[2] + wide}; ++at)
          for (const std::uint32_t other : at->second) visit(other);
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cellOf(std::uint32_t i) const {
    const formats::Vec3f& p = m_tree.centre[i];
    return {static_cast<std::int64_t>(std::floor(p.x / m_edge)),
            static_cast<std::int64_t>(std::floor(p.y / m_edge)),
            static_cast<std::int64_t>(std::floor(p.z / m_edge))};
  }

  const formats::CenterlineTree& m_tree;
  double m_edge;
  std::map<Cell, std::vector<std::uint32_t>> m_cell;
};

// Paths along the tree from one node, up to the lengths that matter.
class TreeDistances {
public:
  TreeDistances(const formats::CenterlineTree& tree, const formats::Neighbours& edges)
      : m_tree(tree), m_edges(edges), m_length(tree.nodeCount(), -1) {}

  void from(std::uint32_t start, double farthest) {
    for (const std::uint32_t node : m_reached) m_length[node] = -1;
    m_reached.assign(1, start);
    m_length[start] = 0;
    for (std::size_t head = 0; head < m_reached.size(); ++head) {
      const std::uint32_t at = m_reached[head];
      if (m_length[at] > farthest) continue;
      for (const std::uint32_t next : m_edges.of(at)) {
        if (m_length[next] >= 0) continue;
        m_length[next] = m_length[at] + distanceOf(m_tree, at, next);
        m_reached.push_back(next);
      }
    }
  }
  // Negative if the path is longer than the requested length.
  [[nodiscard]] double to(std::uint32_t node) const { return m_length[node]; }

private:
  const formats::CenterlineTree& m_tree;
  const formats::Neighbours& m_edges;
  std::vector<double> m_length;
  std::vector<std::uint32_t> m_reached;
};

}  // namespace

void findTouchingNodes(const formats::CenterlineTree& tree, double reach, double margin,
                       double leastPath, std::vector<std::uint32_t>& offset,
                       std::vector<std::uint32_t>& node) {
  const std::size_t count = tree.nodeCount();
  const formats::Neighbours edges(tree);
  std::vector<float> radii(tree.radius);
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  const NodeGrid grid(tree, count == 0 ? 1 : 2 * reach * *middle + margin);
  TreeDistances distances(tree, edges);
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double own = tree.radius[i], farthest = 2 * reach * own + margin;
    distances.from(i, std::max(kDetour * farthest, leastPath * (2 * own + margin)));
    // wide nodes search for narrow ones, not the reverse
    grid.visitNear(i, farthest, [&](std::uint32_t j) {
      const double sum = own + tree.radius[j];
      if (tree.radius[j] > own || (tree.radius[j] == own && j >= i)) return;
      const double distance = distanceOf(tree, i, j), length = distances.to(j);
      if (distance >= reach * sum + margin) return;
      if (length >= 0 && length <= std::max(kDetour * distance, leastPath * (sum + margin))) return;
      pairs.emplace_back(i, j);
      pairs.emplace_back(j, i);
    });
  }
  std::sort(pairs.begin(), pairs.end());
  offset.assign(count + 1, 0);
  node.clear();
  for (const auto& [a, b] : pairs) {
    ++offset[a + 1];
    node.push_back(b);
  }
  for (std::size_t i = 0; i < count; ++i) offset[i + 1] += offset[i];
}

}  // namespace lumen::convert
