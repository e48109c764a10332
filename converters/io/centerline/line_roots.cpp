// SPDX-License-Identifier: Apache-2.0
// Roots of a graph of lines; declared in line_graph.h.
#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"
#include "converters/io/centerline/line_graph.h"

namespace lumen::convert {
namespace {

std::size_t slotOf(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

// Lines from one place run through one vessel if they are this near to each other, in radii, at a
// diameter from it; forks of less than 14 degrees are none.
constexpr double kOneVessel = 0.5;
// Limit of lines that are compared with one another.
constexpr std::size_t kMostCompared = 100;

// By Murray's law an arm of a fork is no wider than what feeds it, and half of the flow takes this
// much less radius.
constexpr double kWider = 1.26;

}  // namespace

void LineGraph::chooseRoot(Part& part) const {
  if (takeHub(part)) return;
  part.root = m_set.isDirected ? sourceOf(part) : kNoPoint;
  part.isAgreed = part.root != kNoPoint && m_next[slotOf(part.root)].size() == 1 &&
                  !feedsWider(part, part.root);
  if (part.isAgreed) return;
  std::vector<Index> candidates = part.ends;
  if (candidates.empty()) candidates.push_back(m_runs[part.runs.front()].nodes.front());  // a ring
  part.root = widest(candidates);
}

// Takes the place at which all lines of a part begin or end for its root, if they run through one
// vessel there, as lines from the root to every tip do, or if they are two that begin there.
bool LineGraph::takeHub(Part& part) const {
  const auto firstOf = [&](std::size_t line) { return m_node[slotOf(m_set.lines[line].front())]; };
  const auto lastOf = [&](std::size_t line) { return m_node[slotOf(m_set.lines[line].back())]; };
  if (part.lines.size() < 2) return false;
  for (const Index hub : {firstOf(part.lines[0]), lastOf(part.lines[0])}) {
    std::size_t begun = 0, touched = 0;
    for (const std::size_t line : part.lines) {
      begun += firstOf(line) == hub ? 1 : 0;
      touched += firstOf(line) == hub || lastOf(line) == hub ? 1 : 0;
    }
    if (touched < part.lines.size()) continue;
    const bool areTwo = part.lines.size() == 2 && begun == 2;
    if (!areTwo && !isOneVessel(part.lines, hub)) continue;
    part.root = hub;
    part.isAgreed = begun == part.lines.size();
    part.chains = std::max(part.runs.size(), part.lines.size());
    return true;
  }
  return false;
}

bool LineGraph::isOneVessel(const std::vector<std::size_t>& lines, Index hub) const {
  const double radius = m_points[slotOf(hub)].radius;
  std::vector<Eigen::Vector3d> places;
  for (const std::size_t line : lines) {
    if (places.size() == kMostCompared) break;
    std::vector<Index> nodes = m_set.lines[line];
    if (m_node[slotOf(nodes.front())] != hub) std::reverse(nodes.begin(), nodes.end());
    double left = 2 * radius;
    Eigen::Vector3d place = m_set.points[slotOf(nodes.front())].position;
    for (std::size_t i = 1; i < nodes.size() && left > 0; ++i) {
      const Eigen::Vector3d step = m_set.points[slotOf(nodes[i])].position - place;
      const double length = step.norm();
      place += length > left ? Eigen::Vector3d(step * (left / length)) : step;
      left -= length;
    }
    for (const Eigen::Vector3d& other : places)
      if ((place - other).norm() <= kOneVessel * radius) return true;
    places.push_back(place);
  }
  return false;
}

// Whether the first run of a part leads to a wider one, and no line runs through a fork: lines of a
// network, which have no direction. An arm of a fork is no wider than what feeds it.
bool LineGraph::feedsWider(const Part& part, Index source) const {
  if (m_hasLinesThroughForks || m_next[slotOf(source)].size() != 1) return false;
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
  for (const Index node : run.nodes) radii.push_back(m_points[slotOf(node)].radius);
  return upperMedian(radii);
}

// The only node into which no run of a part leads, if all others are reached from it; kNoPoint if
// there is none.
LineGraph::Index LineGraph::sourceOf(const Part& part) const {
  std::vector<std::pair<Index, Index>> ways;  // from, to
  for (const std::size_t r : part.runs) {
    const Run& run = m_runs[r];
    const Index first = run.nodes.front(), last = run.nodes.back();
    if (run.votes >= 0) ways.emplace_back(first, last);
    if (run.votes <= 0) ways.emplace_back(last, first);
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
    const double first = m_points[slotOf(a)].radius, second = m_points[slotOf(b)].radius;
    return first < second || (first == second && a > b);
  });
}

std::string LineGraph::rootRemark() const {
  constexpr std::size_t kShown = 3;
  std::string places;
  std::size_t count = 0;
  for (const Part& part : m_parts) {
    if (part.isAgreed) continue;
    if (count++ < kShown)
      places += (places.empty() ? "" : ", ") + vectorText(m_points[slotOf(part.root)].position);
  }
  if (count == 0) return {};
  const std::string why =
      m_set.isDirected ? "its lines run from several ends, or from a narrow vessel to a wider one"
                       : "its lines have no direction";
  return why + "; the root is the widest end, " + places + (count > kShown ? " and others" : "") +
         " in the file's coordinates; " + kOption.root.shown() + " states another";
}

}  // namespace lumen::convert
