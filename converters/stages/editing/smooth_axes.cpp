// SPDX-License-Identifier: Apache-2.0
// Declared in correct_topology.h.
#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/geometry/axis_curve.h"
#include "converters/stages/editing/correct_topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kForkRadii = 2;        // of the thinner vessel, around the place that it leaves
constexpr double kTurnOfRadius = 0.25;  // radians that a radius of distance counts as
constexpr double kCoreOfParent = 0.5;   // of its radius: nodes in it belong to the parent

class Axes {
public:
  explicit Axes(EditableCase& edited) : m_edited(edited), m_owner(edited.nodes.size(), kNoNode) {
    for (std::uint32_t b = 0; b < edited.branches.size(); ++b)
      for (const std::uint32_t node : edited.branches[b].nodes) m_owner[node] = b;
  }

  void smooth() {
    for (EditableBranch& branch : m_edited.branches)
      if (isVessel(branch)) smoothRuns(branch.nodes);
    for (EditableBranch& branch : m_edited.branches)
      if (isVessel(branch) && branch.parent != kNoNode) leaveSmoothly(branch);
  }

private:
  static bool isVessel(const EditableBranch& branch) {
    return branch.record.kind == formats::BranchKind::Vessel;
  }
  [[nodiscard]] bool isBridged(std::uint32_t node) const {
    return m_edited.nodes[node].origin == formats::NodeOrigin::Bridged;
  }
  [[nodiscard]] AxisPoint axisAt(std::uint32_t node) const {
    const EditableNode& at = m_edited.nodes[node];
    return {toEigen(at.centre), toEigen(at.direction), static_cast<double>(at.radius)};
  }
  void move(std::uint32_t node, const AxisPoint& to) {
    EditableNode& moved = m_edited.nodes[node];
    moved.centre = toVec3f(to.position);
    moved.direction = toVec3f(to.direction);
    moved.radius = static_cast<float>(to.radius);
  }

  void smoothRuns(const std::vector<std::uint32_t>& chain) {
    std::size_t last = chain.size();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (isBridged(chain[i])) continue;
      const std::size_t first = std::exchange(last, i);
      if (first + 1 < i) smoothRun(std::span(chain).subspan(first, i - first + 1));
    }
  }

  /// Moves the nodes between the first and the last.
  void smoothRun(std::span<const std::uint32_t> run) {
    const std::vector<std::uint32_t> stretch(run.begin(), run.end());
    const std::vector<AxisPoint> curve = curveBetween(
        axisAt(run.front()), axisAt(run.back()), run.size() - 2, m_edited.measureLength(stretch));
    for (std::size_t i = 0; i < curve.size(); ++i)
      if ((curve[i].position - axisAt(run[i + 1]).position).norm() > curve[i].radius) return;
    for (std::size_t i = 0; i < curve.size(); ++i) move(run[i + 1], curve[i]);
  }

  void leaveSmoothly(EditableBranch& branch) {
    std::vector<std::uint32_t>& nodes = branch.nodes;
    const auto measured = std::find_if(nodes.begin(), nodes.end(),
                                       [this](std::uint32_t node) { return !isBridged(node); });
    if (measured == nodes.end()) return;
    const AxisPoint first = axisAt(*measured);
    const std::vector<std::uint32_t>& parent = m_edited.branches[m_owner[branch.parent]].nodes;
    branch.parent = bestParent(parent, branch.parent, first);
    AxisPoint from = axisAt(branch.parent);
    from.direction = (first.position - from.position).normalized();
    const auto count = static_cast<std::size_t>(measured - nodes.begin());
    const std::vector<AxisPoint> lead =
        curveBetween(from, first, count, (first.position - from.position).norm());
    for (std::size_t i = 0; i < count; ++i) {
      const double radius = axisAt(nodes[i]).radius;
      move(nodes[i], {lead[i].position, lead[i].direction, radius});
    }
    const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(count);
    nodes.erase(std::remove_if(nodes.begin(), end,
                               [&](std::uint32_t node) {
                                 return !isUsed(node) && isInCore(parent, axisAt(node).position);
                               }),
                end);
  }

  /// The node at which a vessel that is measured from `first` on leaves its parent.
  [[nodiscard]] std::uint32_t bestParent(const std::vector<std::uint32_t>& parent,
                                         std::uint32_t now, const AxisPoint& first) const {
    const AxisPoint near = axisAt(now);
    const double reach = kForkRadii * std::min(near.radius, first.radius);
    std::uint32_t best = now;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : parent) {
      const AxisPoint from = axisAt(node);
      if ((from.position - near.position).norm() > reach) continue;
      const double distance = (first.position - from.position).norm();
      const double cost = turnBetween(from, first) + kTurnOfRadius * distance / from.radius;
      if (!(cost < least)) continue;
      least = cost;
      best = node;
    }
    return best;
  }

  [[nodiscard]] bool isInCore(const std::vector<std::uint32_t>& parent, const Vector3d& at) const {
    return std::any_of(parent.begin(), parent.end(), [&](std::uint32_t node) {
      const AxisPoint axis = axisAt(node);
      return (axis.position - at).norm() < kCoreOfParent * axis.radius;
    });
  }

  /// Whether a vessel or a link hangs on a node.
  [[nodiscard]] bool isUsed(std::uint32_t node) const {
    return std::any_of(m_edited.branches.begin(), m_edited.branches.end(),
                       [&](const EditableBranch& branch) { return branch.parent == node; }) ||
           std::any_of(m_edited.links.begin(), m_edited.links.end(),
                       [&](const auto& link) { return link[0] == node || link[1] == node; });
  }

  EditableCase& m_edited;
  std::vector<std::uint32_t> m_owner;  ///< the branch of each node, or kNoNode
};

}  // namespace

void smoothAxes(EditableCase& edited) {
  Axes(edited).smooth();
}

}  // namespace lumen::convert
