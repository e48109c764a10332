// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/correct_topology.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/editing/editable_case.h"
#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;

constexpr double kTouching = 1.25;   // of both radii: vessels whose axes are this near touch
constexpr double kLeastShare = 0.5;  // of the widest end: an end that leaves the volume is the root

/// An end of a vessel that may continue beyond it.
struct VesselEnd {
  std::uint32_t node = 0;
  std::size_t chain = 0;
  Vector3d position, outward;
  double radius = 0;
  std::uint32_t parent = kNoNode;   ///< node that it hangs on; none for a tip
  std::vector<std::uint32_t> stem;  ///< nodes between both, which lie where two vessels touch

  [[nodiscard]] bool isStart() const { return parent != kNoNode; }
};

/// Two ends that are one vessel.
struct Match {
  std::size_t a = 0, b = 0;
  double cost = 0;
};

class TopologyCorrector {
public:
  TopologyCorrector(formats::Case& target, const LumenInVolume& around)
      : m_case(target), m_around(around), m_edited(target), m_graph(m_edited) {}

  std::vector<Vector3d> correct() {
    std::vector<std::uint32_t> before = m_graph.formerRoots();
    for (const std::uint32_t node : m_graph.cutBetweenSystems()) before.push_back(node);
    m_graph.orient(before);
    const std::vector<Match> joined = chosen(matches(findEnds(m_graph.chains())));
    join(joined);
    std::vector<Vector3d> places = joinOverlappingEnds(m_graph);
    cutFalseConnections(m_graph);
    const auto isLumenBetween = [&](const Vector3d& a, const Vector3d& b) { return isOpen(a, b); };
    for (const Vector3d& place : joinIntoSides(m_graph, isLumenBetween)) places.push_back(place);
    cutFalseConnections(m_graph);
    for (const Vector3d& place : joinAcrossVoids(m_graph)) places.push_back(place);
    for (bool isMore = true; isMore;) {  // vessels that are joined may run in others
      m_graph.orient(roots());
      const std::vector<Vector3d> merged = mergeDoubledTracks(m_graph);
      places.insert(places.end(), merged.begin(), merged.end());
      isMore = !merged.empty();
    }
    cutFalseConnections(m_graph);
    m_graph.orient(roots());
    rebuild();
    for (const Match& match : joined) places.push_back(m_ends[match.a].position);
    return places;
  }

private:
  std::vector<VesselEnd> findEnds(const std::vector<Chain>& chains) const {
    std::vector<VesselEnd> ends;
    const auto add = [&](std::span<const std::uint32_t> nodes, std::size_t chain,
                         std::uint32_t parent, std::vector<std::uint32_t> stem) {
      if (const auto arm = m_graph.armOf(nodes))
        ends.push_back({nodes.front(), chain, m_graph.position(nodes.front()), -arm->direction,
                        arm->radius, parent, std::move(stem)});
    };
    for (std::size_t c = 0; c < chains.size(); ++c) {
      const std::vector<std::uint32_t>& nodes = chains[c].nodes;
      const std::vector<std::uint32_t> back(nodes.rbegin(), nodes.rend());
      add(back, c, kNoNode, {});
      if (chains[c].parent == kNoNode) continue;
      const std::size_t stem = skipBridge(nodes, countStem(chains[c]));
      add(std::span(nodes).subspan(stem), c, chains[c].parent,
          {nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(stem)});
    }
    return ends;
  }

  /// Number of nodes between a parent and the last fork of a vessel that still touches the parent's
  /// vessel: through them a skeleton gets from one vessel into another that passes by.
  [[nodiscard]] std::size_t countStem(const Chain& chain) const {
    const auto arm = m_graph.armOf(chain.nodes);
    if (!arm) return 0;
    const std::vector<std::uint32_t> parents = m_graph.stretchAround(chain.parent);
    const auto touches = [&](std::uint32_t node) {
      return std::any_of(parents.begin(), parents.end(), [&](std::uint32_t parent) {
        return (m_graph.position(node) - m_graph.position(parent)).norm() <=
               kTouching * (m_graph.radius(parent) + arm->radius);
      });
    };
    std::size_t stem = 0;
    for (std::size_t k = 0; k < chain.nodes.size() && touches(chain.nodes[k]); ++k)
      if (m_graph.isFork(chain.nodes[k])) stem = k;
    return stem;
  }

  /// The first node from `first` on that was measured: the bridge from a parent's axis shows no
  /// direction. A node that another vessel leaves ends it.
  [[nodiscard]] std::size_t skipBridge(std::span<const std::uint32_t> nodes,
                                       std::size_t first) const {
    const auto isBridge = [&](std::uint32_t node) {
      return m_edited.nodes[node].origin == formats::NodeOrigin::Bridged && !m_graph.isFork(node);
    };
    std::size_t at = first;
    while (at < nodes.size() && isBridge(nodes[at])) ++at;
    return at < nodes.size() ? at : first;
  }

  /// Cost of one vessel through two ends; empty if they are none.
  [[nodiscard]] std::optional<double> joinCost(const VesselEnd& a, const VesselEnd& b) const {
    if (m_graph.areApart(a.node, b.node)) return std::nullopt;
    const Vector3d gap = b.position - a.position;
    const double length = gap.norm(), wide = a.radius + b.radius;
    double reach = kArmEndRadii * wide;  // beyond, the arms of both ends show nothing
    if (a.isStart() && b.isStart()) reach = std::max(reach, 2 * (m_graph.radius(a.parent) + wide));
    const double ratio = std::max(a.radius, b.radius) / std::min(a.radius, b.radius);
    if (length > reach || ratio > kLikeRadii) return std::nullopt;
    const double facing = -a.outward.dot(b.outward);
    if (facing < kFacingCosine) return std::nullopt;
    double ahead = 1;
    if (length > 0.5 * wide) ahead = std::min(a.outward.dot(gap), -b.outward.dot(gap)) / length;
    if (ahead < kAheadOfEnd) return std::nullopt;
    if (!isOpen(a.position, b.position) && !isHidden(a, b)) return std::nullopt;
    if (a.isStart() && b.isStart() && !crosses(a, b)) return std::nullopt;
    return length / wide + 2 * (2 - facing - ahead) + 2 * std::log(ratio);
  }

  [[nodiscard]] bool isOpen(const Vector3d& from, const Vector3d& to) const {
    constexpr int kPlaces = 16;
    for (int i = 1; i < kPlaces; ++i)
      if (!m_around.isLumen(from + static_cast<double>(i) / kPlaces * (to - from))) return false;
    return true;
  }

  /// Whether a straight vessel between two ends touches all along the vessel that both leave, which
  /// may turn there: it is not seen from outside of that one's lumen.
  [[nodiscard]] bool isHidden(const VesselEnd& a, const VesselEnd& b) const {
    if (!a.isStart() || !b.isStart()) return false;
    const std::vector<std::uint32_t> hiding = m_graph.stretchAround(a.parent);
    if (std::find(hiding.begin(), hiding.end(), b.parent) == hiding.end()) return false;
    for (const VesselEnd* end : {&a, &b})
      if (!isOpen(end->position, m_graph.position(end->parent))) return false;
    const double wide = std::max(a.radius, b.radius);
    constexpr int kPlaces = 16;
    for (int i = 1; i < kPlaces; ++i) {
      const Vector3d place =
          a.position + static_cast<double>(i) / kPlaces * (b.position - a.position);
      if (std::none_of(hiding.begin(), hiding.end(), [&](std::uint32_t node) {
            return (m_graph.position(node) - place).norm() <
                   kTouching * (m_graph.radius(node) + wide);
          }))
        return false;
    }
    return true;
  }

  /// Whether a node belongs to the stem of an end, or is its first.
  static bool isAtStem(std::uint32_t node, const VesselEnd& end) {
    return node == end.node || std::find(end.stem.begin(), end.stem.end(), node) != end.stem.end();
  }

  /// Whether a vessel keeps its width where two others leave it, as one does that they cross. One
  /// that divides loses the cubes of their radii (C. D. Murray, "The physiological principle of
  /// minimum work", 1926).
  [[nodiscard]] bool crosses(const VesselEnd& a, const VesselEnd& b) const {
    // one that hangs on the stem of the other crosses what the stem hangs on
    const bool isOnB = isAtStem(a.parent, b), isOnA = isAtStem(b.parent, a);
    const auto widths =
        m_graph.widthsAround(isOnB ? b.parent : a.parent, isOnA ? a.parent : b.parent);
    if (!widths) return true;
    const auto [before, after] = *widths;
    const double left = before * before * before - std::pow(a.radius, 3) - std::pow(b.radius, 3);
    const double divided = std::cbrt(std::max(left, 0.0));
    return std::abs(after - before) <= std::abs(after - divided);
  }

  std::vector<Match> matches(std::vector<VesselEnd> ends) {
    m_ends = std::move(ends);
    std::vector<Match> found;
    for (std::size_t a = 0; a < m_ends.size(); ++a)
      for (std::size_t b = a + 1; b < m_ends.size(); ++b) {
        if (m_ends[a].chain == m_ends[b].chain) continue;
        if (const auto cost = joinCost(m_ends[a], m_ends[b])) found.push_back({a, b, *cost});
      }
    std::stable_sort(found.begin(), found.end(),
                     [](const Match& x, const Match& y) { return x.cost < y.cost; });
    return found;
  }

  /// The best matches, of which each end has one at most.
  [[nodiscard]] std::vector<Match> chosen(const std::vector<Match>& all) const {
    std::vector<bool> isUsed(m_ends.size(), false);
    std::vector<Match> out;
    for (const Match& match : all) {
      if (isUsed[match.a] || isUsed[match.b]) continue;
      isUsed[match.a] = isUsed[match.b] = true;
      out.push_back(match);
    }
    return out;
  }

  void join(const std::vector<Match>& matches) {
    for (const Match& match : matches)
      for (const VesselEnd* end : {&m_ends[match.a], &m_ends[match.b]})
        if (end->isStart()) m_graph.detach(end->node, end->stem);
    for (const Match& match : matches) m_graph.join(m_ends[match.a].node, m_ends[match.b].node);
  }

  /// The end of each tree at which blood comes in.
  std::vector<std::uint32_t> roots() {
    struct Best {
      std::uint32_t node = kNoNode;
      double radius = 0;
    };
    std::vector<std::uint32_t> out;
    for (const std::vector<std::uint32_t>& ends : m_graph.endsOfTrees()) {
      Best widest, leaving;
      for (const std::uint32_t node : ends) {
        const auto arm = m_graph.armFrom(node);
        const double radius = arm ? arm->radius : 0;
        if (radius > widest.radius || widest.node == kNoNode) widest = {node, radius};
        const bool leaves =
            arm && !m_around.isInside(m_graph.position(node) - 2 * radius * arm->direction);
        if (leaves && radius > leaving.radius) leaving = {node, radius};
      }
      const bool byFace = leaving.node != kNoNode && leaving.radius >= kLeastShare * widest.radius;
      out.push_back(byFace ? leaving.node : widest.node);
    }
    return out;
  }

  void rebuild() {
    const std::vector<formats::Step> before = m_case.metadata.steps;
    const std::vector<formats::StopReason> reasons = m_graph.reasonsAtEnds();
    std::vector<EditableBranch> branches;
    for (Chain& chain : m_graph.chains()) {
      EditableBranch branch;
      branch.record.kind = BranchKind::Vessel;
      branch.record.label = provisionalName(branches.size() + 1);
      branch.record.stopReason = reasons[chain.nodes.back()];
      if (!m_case.tree.inlierRate.empty()) branch.record.meanInlierRate = 0.0F;  // until finish()
      branch.parent = chain.parent;
      branch.nodes = std::move(chain.nodes);
      branch.isOther = true;
      branches.push_back(std::move(branch));
    }
    std::size_t sacs = 0;
    for (EditableBranch& branch : m_edited.branches) {
      if (branch.record.kind == BranchKind::Vessel) continue;
      branch.record.label = "aneurysm-" + std::to_string(++sacs);
      branches.push_back(std::move(branch));
    }
    m_edited.branches = std::move(branches);
    m_graph.turnDirections();
    smoothAxes(m_edited);
    m_edited.finish(m_case, "corrected the topology");
    m_case.metadata.steps = before;  // no person has edited the case
  }

  formats::Case& m_case;
  const LumenInVolume& m_around;
  EditableCase m_edited;
  NodeGraph m_graph;
  std::vector<VesselEnd> m_ends;
};

}  // namespace

std::vector<Vector3d> correctTopology(formats::Case& target, const LumenInVolume& around) {
  return TopologyCorrector(target, around).correct();
}

}  // namespace lumen::convert
