// SPDX-License-Identifier: Apache-2.0
#include "neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumen::blob {
namespace {

// Bounds on the work and memory of one node, whatever the tree.
constexpr std::size_t kMaxVisited = 96;
constexpr std::size_t kMaxDistant = 24;  // neighbours that are not edges
constexpr int kMaxEdges = 12;
constexpr int kMaxHidden = 6;        // edges between nodes with only hidden ones between
constexpr double kSlack = 0.15;      // of a radius squared: a cell this shallow counts as hidden
constexpr double kMaxPath = 3.0;     // of the sum of both radii
constexpr double kMaxSpacing = 0.9;  // of the sum: the balls' common disc has 0.44 of a radius

using Pair = std::pair<std::uint32_t, std::uint32_t>;

double distanceOf(const blob_model_def& def, std::uint32_t a, std::uint32_t b) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = double{def.centre[a][i]} - double{def.centre[b][i]};
    square += d * d;
  }
  return std::sqrt(square);
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

std::vector<Pair> edgePairs(const blob_model_def& def) {
  std::vector<Pair> pairs;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  };
  if (def.parent != nullptr)
    for (std::size_t i = 0; i < def.node_count; ++i)
      if (def.parent[i] >= 0)
        add(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(def.parent[i]));
  for (std::size_t i = 0; i < def.link_count; ++i) add(def.link[i][0], def.link[i][1]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

// One node that a breadth-first search has reached.
struct Reached {
  std::uint32_t node;
  int edges;         // from the start
  double path;       // length along the tree, mm
  bool turned;       // a node with three or more edges lies between
  std::size_t from;  // place of the node before in the list
};

class Search {
public:
  Search(const blob_model_def& def, const Neighbourhood& edges)
      : m_def(def),
        m_edges(edges),
        m_distant(def.node_count, 0),
        m_reachedFrom(def.node_count, BLOB_NOWHERE) {}

  std::vector<Pair> distantPairs() {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < m_def.node_count; ++i) {
      reachFrom(i);
      for (const Reached& there : m_reached) {
        if (there.edges < 2 || there.node < i || !isNeighbour(there)) continue;
        if (m_distant[i] >= kMaxDistant || m_distant[there.node] >= kMaxDistant) continue;
        ++m_distant[i];
        ++m_distant[there.node];
        pairs.emplace_back(i, there.node);
      }
    }
    return pairs;
  }

private:
  [[nodiscard]] std::size_t degree(std::uint32_t node) const {
    return m_edges.offset[node + 1] - m_edges.offset[node];
  }

  [[nodiscard]] bool isNeighbour(const Reached& there) const {
    if (there.edges == 2) return true;
    const std::uint32_t start = m_reached[0].node;
    if (there.edges <= kMaxHidden && hidesBetween(start, there)) return true;
    const double sum = double{m_def.radius[start]} + double{m_def.radius[there.node]};
    return there.turned && there.path <= kMaxPath * sum &&
           distanceOf(m_def, start, there.node) < kMaxSpacing * sum;
  }

  // Half way, by power, from node to node, none of those between has clearly less power than these
  // two: their cells hardly part the two, so a cursor must be able to pass.
  [[nodiscard]] bool hidesBetween(std::uint32_t start, const Reached& there) const {
    const double d = distanceOf(m_def, start, there.node);
    const double ra = m_def.radius[start], rb = m_def.radius[there.node];
    const double share =
        d > 0 ? std::clamp(0.5 * (1.0 + (ra * ra - rb * rb) / (d * d)), 0.0, 1.0) : 0.0;
    double tie[3];
    for (int i = 0; i < 3; ++i) {
      const double a = m_def.centre[start][i], b = m_def.centre[there.node][i];
      tie[i] = a + share * (b - a);
    }
    const double thin = std::min(ra, rb);
    const double level = powerOf(start, tie) - kSlack * thin * thin;
    for (std::size_t at = there.from; at != 0; at = m_reached[at].from)
      if (powerOf(m_reached[at].node, tie) < level) return false;
    return true;
  }

  [[nodiscard]] double powerOf(std::uint32_t node, const double* point) const {
    double power = -double{m_def.radius[node]} * double{m_def.radius[node]};
    for (int i = 0; i < 3; ++i) {
      const double d = point[i] - double{m_def.centre[node][i]};
      power += d * d;
    }
    return power;
  }

  void reachFrom(std::uint32_t start) {
    m_reached.assign(1, {start, 0, 0.0, false, 0});
    m_reachedFrom[start] = start;
    for (std::size_t head = 0; head < m_reached.size(); ++head) {
      const Reached from = m_reached[head];
      if (from.edges >= kMaxEdges) continue;
      const bool turned = from.turned || (head > 0 && degree(from.node) > 2);
      for (std::uint32_t e = m_edges.offset[from.node]; e < m_edges.offset[from.node + 1]; ++e) {
        if (m_reached.size() >= kMaxVisited) return;
        const std::uint32_t node = m_edges.node[e];
        if (m_reachedFrom[node] == start) continue;
        m_reachedFrom[node] = start;
        m_reached.push_back(
            {node, from.edges + 1, from.path + distanceOf(m_def, from.node, node), turned, head});
      }
    }
  }

  const blob_model_def& m_def;
  const Neighbourhood& m_edges;
  std::vector<std::uint32_t> m_distant, m_reachedFrom;
  std::vector<Reached> m_reached;
};

}  // namespace

Neighbourhood edgesOf(const blob_model_def& def) {
  const std::vector<Pair> pairs = edgePairs(def);
  return fromPairs(def.node_count, pairs, pairs.size());
}

Neighbourhood neighbourhoodOf(const blob_model_def& def, const Neighbourhood& edges) {
  std::vector<Pair> pairs = edgePairs(def);
  const std::size_t edgeCount = pairs.size();
  const std::vector<Pair> distant = Search(def, edges).distantPairs();
  pairs.insert(pairs.end(), distant.begin(), distant.end());
  return fromPairs(def.node_count, pairs, edgeCount);
}

}  // namespace lumen::blob
