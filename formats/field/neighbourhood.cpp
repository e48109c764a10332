// SPDX-License-Identifier: Apache-2.0
#include "formats/field/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "formats/field/radical_disc.h"

namespace lumen::field {
namespace {

// Bounds on the work and memory of one node, whatever the tree.
constexpr std::size_t kMaxVisited = 192;
constexpr std::uint32_t kMaxDistant = 32;  // neighbours that are not edges
constexpr double kMaxPath = 4.0;           // path along the tree over the sum of both radii
constexpr double kMaxDetour = 2.0;         // path along the tree over the distance

using Pair = std::pair<std::uint32_t, std::uint32_t>;

double squareOf(const TreeView& tree, std::uint32_t a, std::uint32_t b) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = double{tree.centre[a][i]} - double{tree.centre[b][i]};
    square += d * d;
  }
  return square;
}

double distanceOf(const TreeView& tree, std::uint32_t a, std::uint32_t b) {
  return std::sqrt(squareOf(tree, a, b));
}

Neighbourhood fromPairs(std::size_t nodeCount, const std::vector<Pair>& pairs,
                        std::size_t edgeCount) {
  Neighbourhood result;
  result.offset.assign(nodeCount + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++result.offset[a + 1];
    ++result.offset[b + 1];
  }
  for (std::size_t i = 0; i < nodeCount; ++i) result.offset[i + 1] += result.offset[i];
  std::vector<std::pair<std::uint32_t, bool>> entries(result.offset[nodeCount]);
  std::vector<std::uint32_t> next(result.offset.begin(), result.offset.end() - 1);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    entries[next[pairs[p].first]++] = {pairs[p].second, p < edgeCount};
    entries[next[pairs[p].second]++] = {pairs[p].first, p < edgeCount};
  }
  for (std::size_t i = 0; i < nodeCount; ++i)
    std::sort(entries.begin() + result.offset[i], entries.begin() + result.offset[i + 1]);
  result.node.reserve(entries.size());
  result.isEdge.reserve(entries.size());
  for (const auto& [node, isEdge] : entries) {
    result.node.push_back(node);
    result.isEdge.push_back(isEdge);
  }
  return result;
}

std::vector<Pair> edgePairs(const TreeView& tree) {
  std::vector<Pair> pairs;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  };
  if (tree.parent != nullptr)
    for (std::size_t i = 0; i < tree.nodeCount; ++i)
      if (tree.parent[i] >= 0)
        add(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(tree.parent[i]));
  for (std::size_t i = 0; i < tree.linkCount; ++i) add(tree.link[i][0], tree.link[i][1]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

// One node that the breadth-first search has reached.
struct Reached {
  std::uint32_t node;
  int edges;         // edges from the start
  double path;       // length along the tree, mm
  std::size_t from;  // place of the previous node in the list
};

class DistantPairSearch {
public:
  DistantPairSearch(const TreeView& tree, const Neighbourhood& edges)
      : m_tree(tree),
        m_edges(edges),
        m_spacing(measureSpacings(tree, edges)),
        m_reachedFrom(tree.nodeCount, kNowhere) {}

  // Adds the nearest along the tree first, while both nodes have room.
  std::vector<Pair> distantPairs() {
    std::vector<std::pair<double, Pair>> found;
    for (std::uint32_t i = 0; i < m_tree.nodeCount; ++i) {
      reachFrom(i);
      std::uint32_t room = kMaxDistant;
      for (std::size_t n = 1; n < m_reached.size() && room > 0; ++n) {
        const Reached& there = m_reached[n];
        if (there.edges < 2 || !isNeighbour(there)) continue;
        found.push_back({there.edges == 2 ? 0.0 : there.path,
                         {std::min(i, there.node), std::max(i, there.node)}});
        --room;
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tie(a.second, a.first) < std::tie(b.second, b.first);
    });
    found.erase(std::unique(found.begin(), found.end(),
                            [](const auto& a, const auto& b) { return a.second == b.second; }),
                found.end());
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> count(m_tree.nodeCount, 0);
    std::vector<Pair> pairs;
    for (const auto& [path, pair] : found) {
      if (std::max(count[pair.first], count[pair.second]) >= kMaxDistant) continue;
      ++count[pair.first];
      ++count[pair.second];
      pairs.push_back(pair);
    }
    return pairs;
  }

private:
  [[nodiscard]] bool isNeighbour(const Reached& there) {
    if (there.edges == 2) return true;
    const std::uint32_t start = m_reached[0].node;
    const double sum = double{m_tree.radius[start]} + double{m_tree.radius[there.node]};
    const double distance = distanceOf(m_tree, start, there.node);
    if (there.path > kMaxPath * sum) return false;
    return (distance < sum || there.path < kMaxDetour * distance) && meet(start, there);
  }

  // Whether the cells of two nodes meet, within reach of a tool, on the plane where their powers
  // are equal. The nodes on the path between cut away where their own power is less by more than
  // the width in which they blend with the two.
  [[nodiscard]] bool meet(std::uint32_t start, const Reached& there) {
    RadicalDisc disc(m_tree, start, there.node);
    for (std::size_t at = there.from; at != 0 && !disc.isEmpty(); at = m_reached[at].from) {
      const Reached& between = m_reached[at];
      const double width = std::max(widthBetween(start, between.node, between.edges == 1),
                                    widthBetween(there.node, between.node, at == there.from));
      disc.cut(m_tree, between.node, width);
    }
    return !disc.isEmpty();
  }

  [[nodiscard]] double widthBetween(std::uint32_t a, std::uint32_t b, bool isEdge) const {
    return blendingWidth(m_tree, a, b, isEdge, 0.5 * (m_spacing[a] + m_spacing[b]));
  }

  void reachFrom(std::uint32_t start) {
    const double farthest = 2.0 * kMaxPath * m_tree.radius[start];
    m_reached.assign(1, {start, 0, 0.0, 0});
    m_reachedFrom[start] = start;
    for (std::size_t head = 0; head < m_reached.size(); ++head) {
      const Reached from = m_reached[head];
      if (from.edges >= 2 && from.path > farthest) continue;
      for (std::uint32_t e = m_edges.offset[from.node]; e < m_edges.offset[from.node + 1]; ++e) {
        if (m_reached.size() >= kMaxVisited) return;
        const std::uint32_t node = m_edges.node[e];
        if (m_reachedFrom[node] == start) continue;
        m_reachedFrom[node] = start;
        m_reached.push_back(
            {node, from.edges + 1, from.path + distanceOf(m_tree, from.node, node), head});
      }
    }
  }

  const TreeView& m_tree;
  const Neighbourhood& m_edges;
  std::vector<double> m_spacing;
  std::vector<std::uint32_t> m_reachedFrom;
  std::vector<Reached> m_reached;
};

}  // namespace

std::vector<double> measureSpacings(const TreeView& tree, const Neighbourhood& edges) {
  std::vector<double> result(tree.nodeCount, 0.0);
  for (std::uint32_t i = 0; i < tree.nodeCount; ++i)
    for (std::uint32_t e = edges.offset[i]; e < edges.offset[i + 1]; ++e)
      result[i] = std::max(result[i], squareOf(tree, i, edges.node[e]));
  return result;
}

double blendingWidth(const TreeView& tree, std::uint32_t i, std::uint32_t k, bool isEdge,
                     double spacing) {
  return blendingWidth(squareOf(tree, i, k), std::min(tree.radius[i], tree.radius[k]), isEdge,
                       spacing);
}

double blendingWidth(double square, double smallerRadius, bool isEdge, double spacing) {
  constexpr double kShare = 0.6;
  constexpr double kLeastShare = 1e-3;  // of a radius squared: nodes in one place share evenly
  const double width = isEdge ? kShare * square : std::min(0.5 * square, kShare * spacing);
  return std::max(width, kLeastShare * smallerRadius * smallerRadius);
}

std::vector<std::uint32_t> findLenders(const Neighbourhood& edges, const std::uint32_t* offset) {
  const std::size_t count = edges.offset.size() - 1;
  std::vector<std::uint32_t> queue, lender(count, kNowhere);
  for (std::uint32_t i = 0; i < count; ++i)
    if (offset[i] < offset[i + 1]) {
      queue.push_back(i);
      lender[i] = i;
    }
  for (std::size_t head = 0; head < queue.size(); ++head)
    for (std::uint32_t e = edges.offset[queue[head]]; e < edges.offset[queue[head] + 1]; ++e) {
      const std::uint32_t node = edges.node[e];
      if (lender[node] != kNowhere) continue;
      lender[node] = lender[queue[head]];
      queue.push_back(node);
    }
  return lender;
}

Neighbourhood findEdges(const TreeView& tree) {
  const std::vector<Pair> pairs = edgePairs(tree);
  return fromPairs(tree.nodeCount, pairs, pairs.size());
}

Neighbourhood findNeighbourhood(const TreeView& tree, const Neighbourhood& edges) {
  std::vector<Pair> pairs = edgePairs(tree);
  const std::size_t edgeCount = pairs.size();
  const std::vector<Pair> distant = DistantPairSearch(tree, edges).distantPairs();
  pairs.insert(pairs.end(), distant.begin(), distant.end());
  return fromPairs(tree.nodeCount, pairs, edgeCount);
}

}  // namespace lumen::field
