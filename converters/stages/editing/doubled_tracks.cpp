// SPDX-License-Identifier: Apache-2.0
// Declared in correct_topology.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "converters/geometry/box.h"
#include "converters/stages/editing/correct_topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Nodes = std::span<const std::uint32_t>;

/// Radii from an axis within which another one runs in the same lumen, and the least cosine of two
/// that run along one another: a vessel that crosses, or leaves, turns away sooner.
constexpr double kDeepRadii = 0.5, kAlongCosine = 0.8;
/// Radii of a vessel: another whose axis stays deep in it for longer does not cross it.
constexpr double kStretchRadii = 2;
/// Times both radii: places that a longer path joins belong to no joint (docs/method.md, section 7.3).
constexpr double kJointRadii = 4;
/// Times both radii: a longer path between two places that become one is a loop of vessels.
constexpr double kLoopRadii = 8;

/// Vessels whose axes may run in one another's lumen.
class DoubledTracks {
public:
  explicit DoubledTracks(NodeGraph& graph) : m_graph(graph) {
    for (Chain& chain : graph.chains()) m_chains.push_back(std::move(chain.nodes));
    std::stable_sort(m_chains.begin(), m_chains.end(), [&](const auto& a, const auto& b) {
      return graph.countMeasured(a) > graph.countMeasured(b);
    });
    for (const auto& chain : m_chains) {
      m_boxes.emplace_back();
      for (const std::uint32_t node : chain)
        m_boxes.back().add(graph.position(node), graph.radius(node));
    }
  }

  /// The better measured of two vessels keeps the lumen.
  std::vector<Vector3d> merge() {
    std::vector<Vector3d> places;
    for (std::size_t kept = 0; kept < m_chains.size(); ++kept)
      for (std::size_t other = kept + 1; other < m_chains.size(); ++other)
        if (m_boxes[kept].meets(m_boxes[other])) mergeInto(m_chains[kept], m_chains[other], places);
    return places;
  }

private:
  struct Run {
    std::size_t first = 0, end = 0;
  };

  [[nodiscard]] Vector3d chord(Nodes nodes, std::size_t i) const {
    return (m_graph.position(nodes[std::min(i + 1, nodes.size() - 1)]) -
            m_graph.position(nodes[i > 0 ? i - 1 : 0]))
        .normalized();
  }

  /// The place in a vessel's nodes of the one nearest to a point, if that lies deep in its lumen.
  [[nodiscard]] std::optional<std::size_t> deepIn(Nodes vessel, const Vector3d& point) const {
    std::optional<std::size_t> best;
    double least = kDeepRadii;
    for (std::size_t i = 0; i < vessel.size(); ++i) {
      const Vector3d away = point - m_graph.position(vessel[i]);
      const Vector3d along = chord(vessel, i);
      const double radius = m_graph.radius(vessel[i]), ahead = away.dot(along);
      if (std::abs(ahead) > radius) continue;
      const double share = (away - ahead * along).norm() / radius;
      if (share >= least) continue;
      least = share;
      best = i;
    }
    return best;
  }

  /// Whether a point lies within its radius of a free end of a vessel.
  [[nodiscard]] bool isAtEndOf(Nodes vessel, const Vector3d& point) const {
    const auto holds = [&](std::uint32_t end) {
      return m_graph.neighbours(end).size() < 2 &&
             (m_graph.position(end) - point).norm() < m_graph.radius(end);
    };
    return holds(vessel.front()) || holds(vessel.back());
  }

  [[nodiscard]] bool isBeyondJoint(std::uint32_t a, std::uint32_t b) const {
    const auto path = m_graph.pathLength(a, b);
    return !path || *path > kJointRadii * (m_graph.radius(a) + m_graph.radius(b));
  }

  [[nodiscard]] double lengthOf(Nodes nodes) const {
    double length = 0;
    for (std::size_t i = 1; i < nodes.size(); ++i)
      length += (m_graph.position(nodes[i]) - m_graph.position(nodes[i - 1])).norm();
    return length;
  }

  /// Whether what a vessel has beyond a run is a bump of the wall: no longer than the other's radius,
  /// or than it is wide, and nothing hangs on it.
  [[nodiscard]] bool isBump(Nodes rest, double radius) const {
    if (rest.empty()) return true;
    const double own = m_graph.radius(rest.front());
    return lengthOf(rest) <= std::max(radius, 2 * own) &&
           std::none_of(rest.begin(), rest.end(), [&](std::uint32_t node) {
             return m_graph.isFork(node) || m_graph.isLinked(node) || m_graph.hasAneurysm(node);
           });
  }

  /// Runs of a vessel deep in another that are one lumen with it beyond their joint: it runs along
  /// the other there, or ends there. Where the other ends, too, joinOverlappingEnds() decides.
  [[nodiscard]] std::vector<Run> runsIn(Nodes kept, Nodes other,
                                        const std::vector<std::optional<std::size_t>>& deep) const {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < other.size(); ++i) {
      if (!deep[i]) continue;
      Run run{i, i};
      bool isAlong = false, isBeyond = false, isAtEnd = false;
      for (; run.end < other.size() && deep[run.end]; ++run.end) {
        const std::size_t at = *deep[run.end];
        isAlong = isAlong || std::abs(chord(kept, at).dot(chord(other, run.end))) > kAlongCosine;
        isBeyond = isBeyond || isBeyondJoint(other[run.end], kept[at]);
        isAtEnd = isAtEnd || isAtEndOf(kept, m_graph.position(other[run.end]));
      }
      const double radius = m_graph.radius(kept[*deep[run.end - 1]]);
      const std::size_t before = run.first > 0 ? 1 : 0, behind = run.end < other.size() ? 1 : 0;
      const Nodes around = other.subspan(run.first - before, run.end - run.first + before + behind);
      const bool isTip = isBump(other.subspan(run.end), radius) && !m_graph.isLinked(other.back());
      if (isBeyond && !isAtEnd && (isTip || (isAlong && lengthOf(around) > kStretchRadii * radius)))
        runs.push_back(isTip ? Run{run.first, other.size()} : run);
      i = run.end;
    }
    return runs;
  }

  void mergeInto(Nodes kept, std::vector<std::uint32_t>& other, std::vector<Vector3d>& places) {
    if (m_graph.areApart(kept.front(), other.front())) return;
    std::vector<std::optional<std::size_t>> deep;
    for (const std::uint32_t node : other)
      deep.push_back(isGone(node) ? std::nullopt : deepIn(kept, m_graph.position(node)));
    for (const Run& run : runsIn(kept, other, deep)) {
      places.push_back(m_graph.position(other[run.first]));
      std::vector<std::uint32_t> into;
      for (std::size_t i = run.first; i < run.end; ++i)
        into.push_back(deep[i] ? kept[*deep[i]] : into.back());
      replace(Nodes(other).subspan(run.first, run.end - run.first), into);
    }
    std::erase_if(other, [&](std::uint32_t node) { return isGone(node); });
  }

  /// Hangs all that hangs on nodes on others, and drops them.
  void replace(Nodes nodes, Nodes into) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> arms;
    m_gone.insert(nodes.begin(), nodes.end());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (const std::uint32_t next : m_graph.neighbours(nodes[i]))
        if (!isGone(next)) arms.emplace_back(next, into[i]);
      m_graph.hangOn(into[i], nodes[i]);
    }
    m_graph.drop(nodes);
    for (const auto& [node, place] : arms) {
      const auto path = m_graph.pathLength(node, place);
      if (!path)
        m_graph.connect(node, place);
      else if (*path > kLoopRadii * (m_graph.radius(node) + m_graph.radius(place)))
        m_graph.link(node, place);
    }
  }

  [[nodiscard]] bool isGone(std::uint32_t node) const { return m_gone.contains(node); }

  NodeGraph& m_graph;
  std::vector<std::vector<std::uint32_t>> m_chains;  ///< the best measured first
  std::vector<Box3d> m_boxes;
  std::set<std::uint32_t> m_gone;
};

}  // namespace

std::vector<Vector3d> mergeDoubledTracks(NodeGraph& graph) {
  return DoubledTracks(graph).merge();
}

}  // namespace lumen::convert
