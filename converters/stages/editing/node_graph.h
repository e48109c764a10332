// SPDX-License-Identifier: Apache-2.0
// The nodes of the vessels of an editable case as a graph without directions, and the branches that
// follow from its roots.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/editable_case.h"

namespace lumen::convert {

/// Limits on both sides of a gap in one vessel: the cosine between the directions out of one and
/// into the other, that between each and the way to the other, and the ratio of their radii.
constexpr double kFacingCosine = 0.7, kAheadOfEnd = 0.8, kLikeRadii = 1.4;

/// Radii from an end or a fork that show where a vessel leads, from the first radius on: what lies
/// nearer is the shape of a fork, what lies farther may have turned.
constexpr double kArmEndRadii = 4;

/// A vessel between two forks or ends, away from its root.
struct Chain {
  std::uint32_t parent = kNoNode;  ///< node that it leaves
  std::vector<std::uint32_t> nodes;
};

/// The first stretch of a vessel, from an end or a fork on.
struct Arm {
  Eigen::Vector3d direction;  ///< unit, into the vessel
  double radius = 0;          ///< median, mm
  /// three quarters of its radii differ from the median by this ratio at most
  double radiusRatio = 1;
};

class NodeGraph {
public:
  /// Takes the edges of the vessels of an editable case, which must stay; aneurysms are left out.
  explicit NodeGraph(EditableCase& edited);

  /// First nodes of the editable case's branches that have no parent.
  [[nodiscard]] std::vector<std::uint32_t> formerRoots() const;
  /// Directs all edges away from the roots, of which each tree has one.
  void orient(const std::vector<std::uint32_t>& roots);
  /// Vessels away from the roots, parents first, longest tree first: at a fork the vessel that is
  /// widest and straightest goes on.
  [[nodiscard]] std::vector<Chain> chains() const;

  /// The stretch along nodes from their first on; empty if they are shorter than their width.
  [[nodiscard]] std::optional<Arm> armOf(std::span<const std::uint32_t> nodes) const;
  /// The stretch from an end of the graph on, as far as there is no fork, or through forks ahead;
  /// empty if it is shorter than its width.
  [[nodiscard]] std::optional<Arm> armFrom(std::uint32_t end) const;
  /// Mean direction, out of the vessel, of the nodes within two radii of an end of the graph: unlike
  /// an arm it follows a vessel that bends.
  [[nodiscard]] Eigen::Vector3d outwardAt(std::uint32_t end) const;
  /// The nodes of a vessel up to eight radii before and behind one of them, which is among them.
  [[nodiscard]] std::vector<std::uint32_t> stretchAround(std::uint32_t node) const;
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t node) const;
  [[nodiscard]] double radius(std::uint32_t node) const;  ///< mm
  /// Whether the systems of two nodes are never joined.
  [[nodiscard]] bool areApart(std::uint32_t a, std::uint32_t b) const {
    return formats::areApart(m_edited.nodes[a].system, m_edited.nodes[b].system);
  }
  /// Whether more than one vessel leads on from a node.
  [[nodiscard]] bool isFork(std::uint32_t node) const { return m_neighbours[node].size() > 2; }
  /// Radii of a vessel just before and behind two of its nodes, mm; empty if they are not of one.
  /// Both are extrapolated by the usual taper of both sides (H. Theil, "A rank-invariant method of
  /// linear and polynomial regression analysis", 1950), so that a step remains alone.
  [[nodiscard]] std::optional<std::pair<double, double>> widthsAround(std::uint32_t a,
                                                                      std::uint32_t b) const;

  /// Removes the edge to the node that a vessel hangs on, and its first nodes, `stem`, before `node`.
  void detach(std::uint32_t node, std::span<const std::uint32_t> stem);
  /// Removes nodes and their edges.
  void drop(std::span<const std::uint32_t> nodes);
  /// Joins two nodes by a bridge, or by a link behind a bridge if they are connected already.
  void join(std::uint32_t a, std::uint32_t b);
  void connect(std::uint32_t a, std::uint32_t b);
  /// Cuts edges and links between nodes that are apart, and drops the bridges that lead to them.
  /// Returns the nodes at which trees of their own begin.
  [[nodiscard]] std::vector<std::uint32_t> cutBetweenSystems();
  void cut(std::uint32_t a, std::uint32_t b);
  /// Hangs the links and aneurysms of a node on another.
  void hangOn(std::uint32_t node, std::uint32_t from);
  void link(std::uint32_t a, std::uint32_t b) { m_edited.links.push_back({a, b}); }
  /// Whether a link holds a node.
  [[nodiscard]] bool isLinked(std::uint32_t node) const {
    return std::any_of(m_edited.links.begin(), m_edited.links.end(),
                       [&](const auto& link) { return link[0] == node || link[1] == node; });
  }
  /// Removes all links, and returns them.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> takeLinks() {
    return std::exchange(m_edited.links, {});
  }
  /// The ends of each tree; of a tree of one node, that.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> endsOfTrees() const;
  /// The nodes of all vessels that are not within twice its radius of an end.
  [[nodiscard]] std::vector<std::uint32_t> nodesAwayFromEnds() const;
  /// Whether an aneurysm leaves a node.
  [[nodiscard]] bool hasAneurysm(std::uint32_t node) const;
  /// The nodes from an end on, before the first that a vessel or an aneurysm leaves.
  [[nodiscard]] std::vector<std::uint32_t> unforkedFrom(std::uint32_t end) const;
  /// Number of nodes that were measured in a volume.
  [[nodiscard]] std::size_t countMeasured(std::span<const std::uint32_t> nodes) const;
  /// The neighbours of a node.
  [[nodiscard]] const std::vector<std::uint32_t>& neighbours(std::uint32_t node) const {
    return m_neighbours[node];
  }
  /// The stretch from a node on through one of its neighbours; empty if it is shorter than its width.
  [[nodiscard]] std::optional<Arm> armInto(std::uint32_t node, std::uint32_t next) const;
  /// Nodes up to eight radii from one on, through all of its neighbours but `excluded`.
  [[nodiscard]] std::vector<std::uint32_t> throughAllBut(std::uint32_t node,
                                                         std::uint32_t excluded) const;
  /// The nodes along the edges from one to another, with both; empty if none lead there.
  [[nodiscard]] std::vector<std::uint32_t> pathBetween(std::uint32_t a, std::uint32_t b) const;
  /// Length of the path along the edges from one node to another, mm; empty if none leads there.
  [[nodiscard]] std::optional<double> pathLength(std::uint32_t a, std::uint32_t b) const;
  /// Length of all edges of the tree that a node belongs to, mm.
  [[nodiscard]] double treeLength(std::uint32_t node) const;
  /// For each node the reason why a branch of the editable case ended at it.
  [[nodiscard]] std::vector<formats::StopReason> reasonsAtEnds() const;
  /// Lets the directions of all nodes point away from the roots.
  void turnDirections();

private:
  struct Width {
    double at = 0, radius = 0;  ///< mm along a vessel, and there
  };
  /// The radii of a vessel from one to four radii behind the first of its nodes.
  [[nodiscard]] std::vector<Width> widthsAlong(std::span<const std::uint32_t> nodes) const;
  /// The nodes of the tree that a node belongs to, from it on.
  [[nodiscard]] std::vector<std::uint32_t> treeOf(std::uint32_t node) const;
  /// Nodes from one on, each followed by its `next`, over the reach of an arm.
  [[nodiscard]] std::vector<std::uint32_t> follow(std::uint32_t node,
                                                  const std::vector<std::uint32_t>& next) const;
  [[nodiscard]] std::uint32_t findMain(std::uint32_t node) const;
  /// Nodes from one on, away from `before`, over a length, mm; the widest vessel goes on at forks.
  [[nodiscard]] std::vector<std::uint32_t> inwardFrom(std::uint32_t node, double reach,
                                                      std::uint32_t before = kNoNode) const;

  EditableCase& m_edited;
  std::vector<bool> m_isVessel;
  std::vector<std::vector<std::uint32_t>> m_neighbours;
  std::vector<std::uint32_t> m_order;   ///< from the roots on
  std::vector<std::uint32_t> m_parent;  ///< kNoNode for a root
  std::vector<std::uint32_t> m_main;    ///< the neighbour with which the branch goes on, or kNoNode
};

}  // namespace lumen::convert
