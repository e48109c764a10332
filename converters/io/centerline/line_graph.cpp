// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/line_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "converters/geometry/disjoint_sets.h"

namespace lumen::convert {
namespace {

using Index = std::int32_t;

std::size_t at(Index index) {
  return static_cast<std::size_t>(index);
}

using Place = std::array<double, 3>;

Place placeOf(const CenterlinePoint& point) {
  return {point.position.x(), point.position.y(), point.position.z()};
}

// Shortest paths from roots to all nodes that they reach.
struct Paths {
  std::vector<Index> parent;
  std::vector<double> length;  // infinite where no path leads
};

Paths shortestPaths(const std::vector<CenterlinePoint>& points,
                    const std::vector<std::array<Index, 2>>& edges,
                    const std::vector<Index>& roots) {
  std::vector<std::vector<Index>> next(points.size());
  for (const auto& [a, b] : edges) {
    next[at(a)].push_back(b);
    next[at(b)].push_back(a);
  }
  Paths paths{std::vector<Index>(points.size(), kNoPoint),
              std::vector<double>(points.size(), std::numeric_limits<double>::infinity())};
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  for (const Index root : roots) open.emplace(paths.length[at(root)] = 0, root);
  while (!open.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    if (length > paths.length[at(node)]) continue;
    for (const Index other : next[at(node)]) {
      const double longer =
          length + (points[at(node)].position - points[at(other)].position).norm();
      if (longer >= paths.length[at(other)]) continue;
      paths.parent[at(other)] = node;
      open.emplace(paths.length[at(other)] = longer, other);
    }
  }
  return paths;
}

}  // namespace

LineGraph::LineGraph(const LineSet& set)
    : m_set(set), m_node(samePlaces(set)), m_points(set.points) {
  for (std::size_t i = 0; i < m_node.size(); ++i) {
    double& radius = m_points[at(m_node[i])].radius;
    radius = std::max(radius, set.points[i].radius);
  }
  findEdges();
  findParts();
  findRuns();
  for (std::size_t line = 0; line < set.lines.size(); ++line)
    if (hasLength(set.lines[line]))
      m_parts[at(m_partOf[at(m_node[at(set.lines[line].front())])])].lines.push_back(line);
  m_hasLinesThroughForks =
      std::any_of(set.lines.begin(), set.lines.end(), [&](const std::vector<Index>& line) {
        return std::any_of(line.begin(), line.end(), [&](const Index& point) {
          const Index node = m_node[at(point)];
          return m_next[at(node)].size() > 2 && node != m_node[at(line.front())] &&
                 node != m_node[at(line.back())];
        });
      });
  for (Part& part : m_parts) chooseRoot(part);
}

double LineGraph::distance(Index a, Index b) const {
  return (m_points[at(a)].position - m_points[at(b)].position).norm();
}

LineGraph::Index LineGraph::otherEnd(std::size_t edge, Index node) const {
  return m_edges[edge].a == node ? m_edges[edge].b : m_edges[edge].a;
}

bool LineGraph::hasLength(const std::vector<Index>& line) const {
  return std::any_of(line.begin(), line.end(),
                     [&](Index point) { return m_node[at(point)] != m_node[at(line.front())]; });
}

void LineGraph::findEdges() {
  std::vector<Edge> found;
  for (const std::vector<Index>& line : m_set.lines) {
    m_degenerate += hasLength(line) ? 0 : 1;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Index a = m_node[at(line[i - 1])], b = m_node[at(line[i])];
      if (a == b) continue;
      const double length = distance(a, b);
      found.push_back({std::min(a, b), std::max(a, b), a < b ? length : -length});
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.a, a.b) < std::tie(b.a, b.b);
  });
  for (const Edge& edge : found)
    if (!m_edges.empty() && m_edges.back().a == edge.a && m_edges.back().b == edge.b)
      m_edges.back().votes += edge.votes;
    else
      m_edges.push_back(edge);
  m_next.resize(m_points.size());
  for (std::size_t e = 0; e < m_edges.size(); ++e) {
    m_next[at(m_edges[e].a)].push_back(e);
    m_next[at(m_edges[e].b)].push_back(e);
  }
}

void LineGraph::findParts() {
  DisjointSets sets(m_points.size());
  for (const Edge& edge : m_edges)
    sets.join(static_cast<std::uint32_t>(edge.a), static_cast<std::uint32_t>(edge.b));
  m_partOf.assign(m_points.size(), -1);
  for (std::size_t n = 0; n < m_points.size(); ++n) {
    if (m_next[n].empty()) continue;
    const std::size_t first = sets.find(static_cast<std::uint32_t>(n));
    if (first == n) {
      m_partOf[n] = static_cast<Index>(m_parts.size());
      m_parts.emplace_back();
    }
    m_partOf[n] = m_partOf[first];
    if (m_next[n].size() == 1) m_parts[at(m_partOf[n])].ends.push_back(static_cast<Index>(n));
  }
}

void LineGraph::findRuns() {
  std::vector<bool> used(m_edges.size(), false);
  for (std::size_t n = 0; n < m_points.size(); ++n)
    if (m_next[n].size() != 2)
      for (const std::size_t e : m_next[n]) trace(static_cast<Index>(n), e, used);
  for (std::size_t e = 0; e < m_edges.size(); ++e) trace(m_edges[e].a, e, used);  // rings
}

void LineGraph::trace(Index from, std::size_t edge, std::vector<bool>& used) {
  if (used[edge]) return;
  Run run{{from}, 0};
  for (Index node = from;;) {
    used[edge] = true;
    run.votes += m_edges[edge].a == node ? m_edges[edge].votes : -m_edges[edge].votes;
    node = otherEnd(edge, node);
    run.nodes.push_back(node);
    const std::vector<std::size_t>& next = m_next[at(node)];
    if (next.size() != 2) break;
    edge = next[0] == edge ? next[1] : next[0];
    if (used[edge]) break;
  }
  m_parts[at(m_partOf[at(from)])].runs.push_back(m_runs.size());
  m_runs.push_back(std::move(run));
}

bool LineGraph::agreesWith(const CenterlineFile& tree, bool hasVessels) const {
  std::map<Place, Index> nodes;  // of the places of points
  for (std::size_t i = 0; i < m_points.size(); ++i)
    if (m_partOf[at(m_node[i])] >= 0) nodes.emplace(placeOf(m_set.points[i]), m_node[i]);
  std::size_t roots = 0;
  for (const CenterlinePoint& point : tree.points) {
    if (point.parent != kNoPoint) continue;
    ++roots;
    const auto node = nodes.find(placeOf(point));
    if (node != nodes.end() && m_parts[at(m_partOf[at(node->second)])].root != node->second)
      return false;
  }
  std::size_t chains = 0;
  for (const Part& part : m_parts) chains += std::max(part.chains, part.runs.size());
  return roots <= m_parts.size() && (hasVessels || centerlineChains(tree).size() <= chains);
}

std::vector<std::array<LineGraph::Index, 2>> LineGraph::edges() const {
  std::vector<std::array<Index, 2>> edges;
  for (const Edge& edge : m_edges) edges.push_back({edge.a, edge.b});
  return edges;
}

std::vector<bool> LineGraph::turnedLines() const {
  std::vector<Index> roots;
  for (const Part& part : m_parts) roots.push_back(part.root);
  const Paths paths = shortestPaths(m_points, edges(), roots);
  std::vector<bool> turned;
  for (const std::vector<Index>& line : m_set.lines)
    turned.push_back(!line.empty() && paths.length[at(m_node[at(line.front())])] >
                                          paths.length[at(m_node[at(line.back())])]);
  return turned;
}

// Adds an edge from an open end of a part to the nearest axis of another part in whose lumen it
// lies. Returns the roots of what is connected then: that of the only part of which another end, or
// none, was attached, or the widest of several.
std::vector<LineGraph::Index> LineGraph::attachParts(std::vector<std::array<Index, 2>>& edges,
                                                     std::size_t& attached) const {
  DisjointSets joined(m_parts.size());
  std::vector<bool> isAttached(m_points.size(), false);
  if (m_parts.size() > 1 && m_parts.size() <= kMostParts) {
    const AxisSearch search(m_points, edges, m_partOf);
    std::vector<std::tuple<double, Index, Index>> joints;
    for (std::size_t p = 0; p < m_parts.size(); ++p)
      for (const Index end : m_parts[p].ends) {
        const AxisContact contact = search.nearest(end, static_cast<Index>(p));
        if (contact.point != kNoPoint) joints.emplace_back(contact.distance, end, contact.point);
      }
    std::sort(joints.begin(), joints.end());
    for (const auto& [distance, end, on] : joints) {
      const auto a = static_cast<std::uint32_t>(m_partOf[at(end)]);
      const auto b = static_cast<std::uint32_t>(m_partOf[at(on)]);
      if (joined.find(a) == joined.find(b)) continue;
      joined.join(a, b);
      edges.push_back({end, on});
      isAttached[at(end)] = true;
      ++attached;
    }
  }
  std::map<std::uint32_t, std::vector<Index>> candidates;
  for (std::size_t p = 0; p < m_parts.size(); ++p)
    if (const Index root = m_parts[p].root; !isAttached[at(root)])
      candidates[joined.find(static_cast<std::uint32_t>(p))].push_back(root);
  for (std::size_t p = 0; p < m_parts.size(); ++p)  // parts that begin in one another
    candidates.try_emplace(joined.find(static_cast<std::uint32_t>(p)),
                           std::vector<Index>{m_parts[p].root});
  std::vector<Index> roots;
  for (const auto& [part, ends] : candidates) roots.push_back(widest(ends));
  return roots;
}

CenterlineFile LineGraph::tree() const {
  std::vector<std::array<Index, 2>> all = edges();
  std::size_t attached = 0;
  const std::vector<Index> roots = attachParts(all, attached);
  const Paths paths = shortestPaths(m_points, all, roots);
  CenterlineFile file;
  Index vessels = 0;
  std::vector<Index> place(m_points.size(), kNoPoint);
  for (std::size_t n = 0; n < m_points.size(); ++n) {
    if (!std::isfinite(paths.length[n])) continue;
    place[n] = static_cast<Index>(file.points.size());
    file.points.push_back(m_points[n]);
    file.points.back().parent = paths.parent[n];
    vessels = std::max(vessels, m_points[n].vessel + 1);
  }
  for (CenterlinePoint& point : file.points)
    if (point.parent != kNoPoint) point.parent = place[at(point.parent)];
  for (const auto& [a, b] : all)
    if (paths.parent[at(a)] != b && paths.parent[at(b)] != a)
      file.links.push_back({place[at(a)], place[at(b)]});
  file.vessels.resize(at(vessels));
  file.remarks = remarks(file.links.size(), attached);
  orderParentsFirst(file);
  return file;
}

// Sentences on what was mended, one each.
std::vector<std::string> LineGraph::remarks(std::size_t links, std::size_t attached) const {
  std::vector<std::string> sentences;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) sentences.push_back(std::to_string(count) + (count == 1 ? one : many));
  };
  add(m_degenerate, " line without length is left out", " lines without length are left out");
  std::size_t merged = 0;
  for (std::size_t i = 0; i < m_node.size(); ++i) merged += at(m_node[i]) != i ? 1 : 0;
  add(merged, " point at the place of another one is one with it",
      " points at the places of others are one with these");
  add(attached, " part that begins or ends in the lumen of another part is attached to it",
      " parts that begin or end in the lumen of other parts are attached to these");
  add(links, " edge that closes a loop is kept as a link",
      " edges that close loops are kept as links");
  return sentences;
}

}  // namespace lumen::convert
