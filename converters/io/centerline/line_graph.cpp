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
#include <unordered_set>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"
#include "converters/geometry/disjoint_sets.h"

namespace lumen::convert {
namespace {

using Index = std::int32_t;

std::size_t at(Index index) {
  return static_cast<std::size_t>(index);
}

// Away from the root, and towards it.
constexpr double kAway = 1, kTowards = -1;

// By Murray's law an arm of a fork is no wider than what feeds it, and half of the flow takes this
// much less radius.
constexpr double kWider = 1.26;

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

void LineGraph::findEdges() {
  std::vector<Edge> found;
  for (const std::vector<Index>& line : m_set.lines) {
    const std::size_t before = found.size();
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Index a = m_node[at(line[i - 1])], b = m_node[at(line[i])];
      if (a == b) continue;
      const double length = distance(a, b);
      found.push_back({std::min(a, b), std::max(a, b), a < b ? length : -length});
    }
    m_degenerate += found.size() == before ? 1 : 0;
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

void LineGraph::chooseRoot(Part& part) const {
  const Index source = m_set.isDirected ? sourceOf(part, kAway) : kNoPoint;
  part.isAgreed = source != kNoPoint && !feedsWider(part, source);
  part.root = source;
  if (part.isAgreed) return;
  std::vector<Index> candidates = part.ends;
  const Index sink = m_set.isDirected ? sourceOf(part, kTowards) : kNoPoint;
  if (sink != kNoPoint) candidates.push_back(sink);
  if (candidates.empty()) candidates.push_back(m_runs[part.runs.front()].nodes.front());  // a ring
  part.root = widest(candidates);
}

// Whether the first run of a part leads to a wider one, and no line runs through a fork: lines of a
// network, which have no direction. An arm of a fork is no wider than what feeds it.
bool LineGraph::feedsWider(const Part& part, Index source) const {
  if (m_hasLinesThroughForks || m_next[at(source)].size() != 1) return false;
  const auto touches = [&](const Run& run, Index node) {
    return run.nodes.front() == node || run.nodes.back() == node;
  };
  const auto first = std::find_if(part.runs.begin(), part.runs.end(),
                                  [&](std::size_t run) { return touches(m_runs[run], source); });
  const Run& feeding = m_runs[*first];
  const Index fork = feeding.nodes.front() == source ? feeding.nodes.back() : feeding.nodes.front();
  const double most = kWider * medianRadius(feeding);
  return std::any_of(part.runs.begin(), part.runs.end(), [&](std::size_t run) {
    return run != *first && touches(m_runs[run], fork) && medianRadius(m_runs[run]) > most;
  });
}

double LineGraph::medianRadius(const Run& run) const {
  std::vector<double> radii;
  for (const Index node : run.nodes) radii.push_back(m_points[at(node)].radius);
  return upperMedian(radii);
}

// The only node into which no run of a part leads, if all others are reached from it; kNoPoint if
// there is none. Runs count backwards in the other direction.
LineGraph::Index LineGraph::sourceOf(const Part& part, double direction) const {
  std::vector<std::pair<Index, Index>> ways;  // from, to
  for (const std::size_t r : part.runs) {
    const Run& run = m_runs[r];
    const Index first = run.nodes.front(), last = run.nodes.back();
    if (run.votes * direction >= 0) ways.emplace_back(first, last);
    if (run.votes * direction <= 0) ways.emplace_back(last, first);
  }
  std::sort(ways.begin(), ways.end());
  std::vector<Index> from, to;
  for (const auto& [a, b] : ways) {
    from.push_back(a);
    to.push_back(b);
  }
  std::sort(to.begin(), to.end());
  Index source = kNoPoint;
  for (const Index node : from) {
    if (node == source || std::binary_search(to.begin(), to.end(), node)) continue;
    if (source != kNoPoint) return kNoPoint;
    source = node;
  }
  if (source == kNoPoint) return kNoPoint;
  std::unordered_set<Index> reached{source};
  std::vector<Index> open{source};
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    for (auto way = std::lower_bound(ways.begin(), ways.end(), std::pair(node, Index{0}));
         way != ways.end() && way->first == node; ++way)
      if (reached.insert(way->second).second) open.push_back(way->second);
  }
  const bool isAll =
      std::all_of(to.begin(), to.end(), [&](Index node) { return reached.count(node) > 0; });
  return isAll ? source : kNoPoint;
}

LineGraph::Index LineGraph::widest(const std::vector<Index>& nodes) const {
  return *std::max_element(nodes.begin(), nodes.end(), [&](Index a, Index b) {
    const double first = m_points[at(a)].radius, second = m_points[at(b)].radius;
    return first < second || (first == second && a > b);
  });
}

bool LineGraph::agreesWith(const CenterlineFile& tree, bool hasVessels) const {
  std::map<Place, const Part*> open;  // ends of parts whose lines do not agree on a root
  for (const Part& part : m_parts)
    if (!part.isAgreed)
      for (const Index end : part.ends) open.emplace(placeOf(m_points[at(end)]), &part);
  std::size_t roots = 0;
  for (const CenterlinePoint& point : tree.points) {
    if (point.parent != kNoPoint) continue;
    ++roots;
    const auto end = open.find(placeOf(point));
    if (end != open.end() && placeOf(m_points[at(end->second->root)]) != end->first) return false;
  }
  return roots <= m_parts.size() && (hasVessels || centerlineChains(tree).size() <= m_runs.size());
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
  std::vector<Index> place(m_points.size(), kNoPoint);
  for (std::size_t n = 0; n < m_points.size(); ++n) {
    if (!std::isfinite(paths.length[n])) continue;
    place[n] = static_cast<Index>(file.points.size());
    file.points.push_back(m_points[n]);
    file.points.back().parent = paths.parent[n];
  }
  for (CenterlinePoint& point : file.points)
    if (point.parent != kNoPoint) point.parent = place[at(point.parent)];
  for (const auto& [a, b] : all)
    if (paths.parent[at(a)] != b && paths.parent[at(b)] != a)
      file.links.push_back({place[at(a)], place[at(b)]});
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

std::string LineGraph::rootRemark() const {
  std::string places;
  std::size_t count = 0;
  for (const Part& part : m_parts) {
    if (part.isAgreed) continue;
    constexpr std::size_t kShown = 3;
    if (count++ < kShown)
      places += (places.empty() ? "" : ", ") + vectorText(m_points[at(part.root)].position);
  }
  if (count == 0) return {};
  return std::string(
             "its lines do not run from one end; the root is taken to be the widest end, ") +
         places + (count > 3 ? " and others" : "") + " in the file's coordinates";
}

}  // namespace lumen::convert
