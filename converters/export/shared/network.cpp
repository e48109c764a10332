// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/network.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/editing/trim.h"

namespace lumen::convert {

namespace {

using formats::Branch;
using formats::BranchKind;
using formats::CenterlineTree;

/// Makes a network of the graph of nodes and edges.
class NetworkBuilder {
public:
  explicit NetworkBuilder(const CenterlineTree& tree)
      : m_tree(tree), m_next(tree.nodeCount()), m_jointOf(tree.nodeCount(), kNone) {
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
      if (tree.parent[n] != formats::kNoParent)
        connect(static_cast<std::uint32_t>(tree.parent[n]), n);
    for (const auto& [a, b] : tree.links) connect(a, b);
    for (std::vector<std::uint32_t>& next : m_next) {
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
    }
    leaveOutDomes();
  }

  FlowNetwork build(const std::vector<StatedInlet>& stated) {
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n)
      if (isBreak(n)) addJoint(n);
    // walks from a joint to the next one, each edge once
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n)
      if (m_jointOf[n] != kNone)
        for (const std::uint32_t next : m_next[n])
          if (!isDone(n, next)) walk(n, next);
    if (m_made.segments.empty())
      throw invalidInput(
          "this case has no vessel with a length, so there is nothing to flow through");
    findTrees();
    for (FlowTree& tree : m_made.trees)
      if (tree.inlets.empty()) addInlet(tree);
    nameEnds();
    setInflows(stated);
    reportSacs();
    return std::move(m_made);
  }

private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  void connect(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    m_next[a].push_back(b);
    m_next[b].push_back(a);
  }

  /// Leaves out the part of an aneurysm to which no vessel is connected: nothing flows through it.
  void leaveOutDomes() {
    std::vector<std::uint32_t> blind;
    const auto look = [&](std::uint32_t n) {
      if (m_tree.branches[m_tree.branch[n]].kind == BranchKind::Aneurysm && m_next[n].size() == 1)
        blind.push_back(n);
    };
    for (std::uint32_t n = 0; n < m_next.size(); ++n) look(n);
    while (!blind.empty()) {
      const std::uint32_t n = blind.back();
      blind.pop_back();
      if (m_next[n].size() != 1) continue;
      const std::uint32_t other = m_next[n].front();
      m_next[n].clear();
      std::erase(m_next[other], n);
      look(other);
    }
  }

  [[nodiscard]] bool isRoot(std::uint32_t n) const {
    return m_tree.parent[n] == formats::kNoParent ||
           m_next[static_cast<std::size_t>(m_tree.parent[n])].empty();
  }
  [[nodiscard]] bool isBreak(std::uint32_t n) const {
    return m_next[n].size() == 1 || m_next[n].size() > 2 || (isRoot(n) && !m_next[n].empty());
  }
  [[nodiscard]] static std::pair<std::uint32_t, std::uint32_t> edge(std::uint32_t a,
                                                                    std::uint32_t b) {
    return std::minmax(a, b);
  }
  [[nodiscard]] bool isDone(std::uint32_t a, std::uint32_t b) const {
    const auto [low, high] = edge(a, b);
    const auto& next = m_next[low];
    const auto at = std::lower_bound(next.begin(), next.end(), high) - next.begin();
    return m_done.size() > low && m_done[low].size() > static_cast<std::size_t>(at) &&
           m_done[low][static_cast<std::size_t>(at)];
  }
  void setDone(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = edge(a, b);
    const auto& next = m_next[low];
    if (m_done.empty()) m_done.resize(m_next.size());
    m_done[low].resize(next.size(), false);
    m_done[low][static_cast<std::size_t>(std::lower_bound(next.begin(), next.end(), high) -
                                         next.begin())] = true;
  }

  void addJoint(std::uint32_t n) {
    FlowJoint joint;
    joint.place = toEigen(m_tree.centre[n]);
    if (m_next[n].size() == 1) joint.kind = isRoot(n) ? JointKind::Inlet : JointKind::Outlet;
    m_jointOf[n] = static_cast<std::uint32_t>(m_made.joints.size());
    m_made.joints.push_back(std::move(joint));
    m_nodeOf.push_back(n);
  }

  /// True if `n` starts at `joint`, or a link joins it to it, and is of another vessel.
  [[nodiscard]] bool isGuest(std::uint32_t n, std::uint32_t joint) const {
    return m_tree.branch[n] != m_tree.branch[joint] &&
           m_tree.parent[joint] != static_cast<std::int32_t>(n);
  }
  /// True if the vessel of `n` comes from before it and goes on behind it.
  [[nodiscard]] bool passesThrough(std::uint32_t n) const {
    const Branch& branch = m_tree.branches[m_tree.branch[n]];
    return n + 1 != branch.firstNode + branch.nodeCount && !isRoot(n);
  }

  /// Sets the segment's end at a joint in another vessel: it has its own radius there, and begins
  /// at the wall if that vessel goes on.
  void beginAtWall(FlowSegment& segment, const std::vector<std::uint32_t>& nodes, bool last) const {
    const std::size_t at = last ? nodes.size() - 1 : 0, beside = last ? at - 1 : 1;
    if (!isGuest(nodes[beside], nodes[at])) return;
    const bool isLink = nodes.size() == 2 && isGuest(nodes[at], nodes[beside]);
    segment.radii[at] = isLink ? std::min(m_tree.radius[nodes[at]], m_tree.radius[nodes[beside]])
                               : m_tree.radius[nodes[beside]];
    if (!passesThrough(nodes[at])) return;
    const Eigen::Vector3d chord = segment.points[beside] - segment.points[at];
    const double length = chord.norm(), inside = m_tree.radius[nodes[at]];
    // of a vessel that is nowhere outside of the other's ball all counts
    if (nodes.size() > 2 || inside < length)
      segment.points[at] += (inside < length ? inside / length : 1.0) * chord;
  }

  void walk(std::uint32_t from, std::uint32_t to) {
    std::vector<std::uint32_t> nodes{from, to};
    setDone(from, to);
    while (m_jointOf[to] == kNone) {
      const std::uint32_t next = m_next[to][0] == from ? m_next[to][1] : m_next[to][0];
      from = std::exchange(to, next);
      nodes.push_back(to);
      setDone(from, to);
    }
    FlowSegment segment;
    segment.branch = m_tree.branch[nodes[1]];
    segment.from = m_jointOf[nodes.front()];
    segment.to = m_jointOf[nodes.back()];
    for (const std::uint32_t n : nodes) {
      segment.points.push_back(toEigen(m_tree.centre[n]));
      segment.radii.push_back(m_tree.radius[n]);
    }
    beginAtWall(segment, nodes, false);
    beginAtWall(segment, nodes, true);
    addSegment(std::move(segment));
  }

  void addSegment(FlowSegment segment) {
    const std::string& label = m_tree.branches[segment.branch].label;
    const int part = ++m_parts[segment.branch];
    segment.name = part == 1 ? label : label + "_" + std::to_string(part);
    const auto index = static_cast<std::uint32_t>(m_made.segments.size());
    m_made.joints[segment.from].out.push_back(index);
    m_made.joints[segment.to].in.push_back(index);
    m_made.segments.push_back(std::move(segment));
  }

  void findTrees() {
    DisjointSets sets(m_made.joints.size());
    for (const FlowSegment& segment : m_made.segments) sets.join(segment.from, segment.to);
    std::map<std::uint32_t, std::uint32_t> numbers;
    std::vector<std::size_t> joints, segments;
    for (std::uint32_t j = 0; j < m_made.joints.size(); ++j) {
      const auto [at, isNew] =
          numbers.emplace(sets.find(j), static_cast<std::uint32_t>(numbers.size()));
      if (isNew) m_made.trees.emplace_back(), joints.push_back(0), segments.push_back(0);
      FlowJoint& joint = m_made.joints[j];
      joint.tree = at->second;
      ++joints[joint.tree];
      segments[joint.tree] += joint.out.size();
      if (joint.kind == JointKind::Inlet) m_made.trees[joint.tree].inlets.push_back(j);
      if (joint.kind == JointKind::Outlet) m_made.trees[joint.tree].outlets.push_back(j);
    }
    for (std::size_t t = 0; t < joints.size(); ++t)
      m_made.trees[t].hasLoop = segments[t] >= joints[t];
  }

  [[nodiscard]] const std::string& labelAt(std::uint32_t joint) const {
    return m_tree.branches[m_tree.branch[m_nodeOf[joint]]].label;
  }

  void addInlet(FlowTree& tree) {
    const auto t = static_cast<std::uint32_t>(&tree - m_made.trees.data());
    std::uint32_t root = 0;
    while (m_made.joints[root].tree != t || !isRoot(m_nodeOf[root])) ++root;
    const std::uint32_t node = m_nodeOf[root];
    const double radius = m_tree.radius[node];
    FlowJoint joint;
    joint.kind = JointKind::Inlet;
    joint.place = m_made.joints[root].place - radius * toEigen(m_tree.direction[node]);
    joint.tree = t;
    FlowSegment entry;
    entry.branch = m_tree.branch[node];
    entry.from = static_cast<std::uint32_t>(m_made.joints.size());
    entry.to = root;
    entry.points = {joint.place, m_made.joints[root].place};
    entry.radii = {radius, radius};
    tree.inlets.push_back(entry.from);
    m_made.joints.push_back(std::move(joint));
    m_nodeOf.push_back(node);
    addSegment(std::move(entry));
    m_made.messages.push_back(
        labelAt(root) +
        ": no single vessel begins at its root, so an inlet of one radius was "
        "put before it");
  }

  void nameEnds() {
    const auto inlets = std::count_if(m_made.joints.begin(), m_made.joints.end(),
                                      [](const auto& j) { return j.kind == JointKind::Inlet; });
    std::size_t junctions = 0;
    for (std::uint32_t j = 0; j < m_made.joints.size(); ++j) {
      FlowJoint& joint = m_made.joints[j];
      if (joint.kind == JointKind::Junction) joint.name = "J" + std::to_string(junctions++);
      if (joint.kind == JointKind::Outlet) joint.name = "outlet-" + labelAt(j);
      if (joint.kind == JointKind::Inlet) joint.name = inlets > 1 ? "inlet-" + labelAt(j) : "inlet";
    }
    for (const FlowTree& tree : m_made.trees)
      if (tree.outlets.empty())
        throw invalidInput(
            m_made.joints[tree.inlets.front()].name +
            ": nothing can flow in here, since its vessels have no end to flow out of");
  }

  void setInflows(const std::vector<StatedInlet>& stated) {
    for (std::uint32_t j = 0; j < m_made.joints.size(); ++j) {
      FlowJoint& joint = m_made.joints[j];
      if (joint.kind != JointKind::Inlet) continue;
      joint.inflow = blood::meanFlow(kMetres * endCalibre(m_made, j));
      for (const StatedInlet& inlet : stated)
        if (inlet.label == labelAt(j) && inlet.flow > 0) joint.inflow = inlet.flow;
    }
  }

  void reportSacs() {
    for (const Branch& branch : m_tree.branches) {
      if (branch.kind != BranchKind::Aneurysm) continue;
      const auto first = m_next.begin() + branch.firstNode;
      const bool flows = std::any_of(first, first + branch.nodeCount,
                                     [](const auto& next) { return !next.empty(); });
      m_made.messages.push_back(
          branch.label + (flows ? ": an aneurysm that a vessel hangs on, so it is a vessel here"
                                : ": an aneurysm, which is left out"));
    }
  }

  const CenterlineTree& m_tree;
  std::vector<std::vector<std::uint32_t>> m_next;  // neighbours of each node, ascending
  std::vector<std::vector<bool>> m_done;           // edges of the lesser node of each, as m_next
  std::vector<std::uint32_t> m_jointOf, m_nodeOf;
  std::map<std::uint32_t, int> m_parts;  // parts of a branch
  FlowNetwork m_made;
};

}  // namespace

double FlowSegment::length() const {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) sum += (points[k + 1] - points[k]).norm();
  return sum;
}

FlowNetwork flowNetwork(const CenterlineTree& tree, const std::vector<StatedInlet>& stated) {
  return NetworkBuilder(tree).build(stated);
}

std::vector<NamedEnd> findEnds(const FlowNetwork& network) {
  std::vector<NamedEnd> ends;
  for (std::uint32_t j = 0; j < network.joints.size(); ++j) {
    const FlowJoint& joint = network.joints[j];
    if (joint.kind == JointKind::Junction) continue;
    const bool isInlet = joint.kind == JointKind::Inlet;
    const FlowSegment& segment = network.segments[isInlet ? joint.out.front() : joint.in.front()];
    const std::size_t last = segment.points.size() - 1;
    NamedEnd end;
    end.name = joint.name;
    end.kind = isInlet ? FaceKind::Inlet : FaceKind::Outlet;
    end.position = joint.place;
    end.radius = endRadius(network, j);
    const Eigen::Vector3d out = isInlet ? segment.points[0] - segment.points[1]
                                        : segment.points[last] - segment.points[last - 1];
    if (out.norm() > 0) end.direction = out.normalized();
    ends.push_back(std::move(end));
  }
  return ends;
}

std::string networkSummary(const FlowNetwork& network) {
  std::size_t inlets = 0, outlets = 0;
  for (const FlowTree& tree : network.trees) {
    inlets += tree.inlets.size();
    outlets += tree.outlets.size();
  }
  return counted(network.segments.size(), "segment", "segments") + ", " +
         counted(network.joints.size() - inlets - outlets, "junction", "junctions") + ", " +
         counted(inlets, "inlet", "inlets") + ", " + counted(outlets, "outlet", "outlets") + ", " +
         counted(network.trees.size(), "tree", "trees");
}

Lumped lumped(const FlowSegment& segment) {
  constexpr double kPi = std::numbers::pi;
  // 3 pi r^3 / (2 E h) of a length
  const auto yields = [](double r) { return 1.5 * kPi * r * r / blood::stiffness(r); };
  Lumped sum;
  for (std::size_t k = 0; k + 1 < segment.points.size(); ++k) {
    const double length = kMetres * (segment.points[k + 1] - segment.points[k]).norm();
    const double a = kMetres * segment.radii[k], b = kMetres * segment.radii[k + 1];
    // the integrals of 1/r^4 and 1/r^2 along a radius that changes linearly
    sum.resistance += 8 * blood::kViscosity / kPi * length * (a * a + a * b + b * b) / 3 /
                      (a * a * a * b * b * b);
    sum.inertance += blood::kDensity / kPi * length / (a * b);
    sum.compliance +=
        length * (yields(a) + 4 * yields(0.5 * (a + b)) + yields(b)) / 6;  // Simpson's
  }
  return sum;
}

double endRadius(const FlowNetwork& network, std::uint32_t joint) {
  const FlowJoint& end = network.joints[joint];
  return end.kind == JointKind::Inlet ? network.segments[end.out.front()].radii.front()
                                      : network.segments[end.in.front()].radii.back();
}

double endCalibre(const FlowNetwork& network, std::uint32_t joint) {
  const FlowJoint& end = network.joints[joint];
  const bool isInlet = end.kind == JointKind::Inlet;
  const FlowSegment& segment = network.segments[isInlet ? end.out.front() : end.in.front()];
  std::vector<double> radii = segment.radii, steps;
  for (std::size_t k = 0; k + 1 < segment.points.size(); ++k)
    steps.push_back((segment.points[k + 1] - segment.points[k]).norm());
  if (!isInlet) {
    std::reverse(radii.begin(), radii.end());
    std::reverse(steps.begin(), steps.end());
  }
  return calibre(radii, steps);
}

std::vector<double> outletShares(const FlowNetwork& network, const FlowTree& tree) {
  double sum = 0;
  std::vector<double> shares;
  for (const std::uint32_t outlet : tree.outlets) {
    shares.push_back(blood::murrayShare(kMetres * endCalibre(network, outlet)));
    sum += shares.back();
  }
  for (double& share : shares) share /= sum;
  return shares;
}

namespace {

double inflowOf(const FlowNetwork& network, const FlowTree& tree) {
  double flow = 0;
  for (const std::uint32_t inlet : tree.inlets) flow += network.joints[inlet].inflow;
  return flow;
}

}  // namespace

std::vector<double> outletResistances(const FlowNetwork& network, const FlowTree& tree) {
  std::vector<double> values = outletShares(network, tree);
  for (double& value : values) value = blood::kMeanPressure / (inflowOf(network, tree) * value);
  return values;
}

}  // namespace lumen::convert
