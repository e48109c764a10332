// SPDX-License-Identifier: Apache-2.0
// widenAround() and pushWall() of wall_edits.h.
#include "converters/stages/editing/wall_edits.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/editable_case.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;

/// Share of its distance from the axis that a wall point keeps when it is pushed inwards: the wall
/// stays around its axis.
constexpr double kNearest = 0.25;
/// Share of the radius below which a point counts as where it was measured.
constexpr double kUnmoved = 0.01;

bool isLength(double value) {
  return static_cast<float>(value) > 0 && value <= kFarthest;
}

/// 1 in the middle and 0 from `reach` on, with a continuous derivative.
double fading(double distance, double reach) {
  const double share = distance / reach;
  return share >= 1 ? 0 : std::pow(1 - share * share, 2);
}

/// Lengths along the branch of `node` from its first node on, mm.
std::vector<double> lengthsAlong(const formats::CenterlineTree& tree,
                                 const formats::Branch& branch) {
  std::vector<double> lengths(branch.nodeCount, 0);
  for (std::uint32_t i = 1; i < branch.nodeCount; ++i)
    lengths[i] = lengths[i - 1] + (toEigen(tree.centre[branch.firstNode + i]) -
                                   toEigen(tree.centre[branch.firstNode + i - 1]))
                                      .norm();
  return lengths;
}

/// A wall point in the frame of its node.
struct Polar {
  double along;     ///< mm along the node's direction
  Vector3d across;  ///< from the axis to the point

  Polar(const EditableNode& node, const Vector3d& p) {
    const Vector3d axis = toEigen(node.direction), from = p - toEigen(node.centre);
    along = from.dot(axis);
    across = from - along * axis;
  }
};

void markEdited(EditableNode& node) {
  node.isEdited = true;
  node.inlierRate = 0;
}

/// Moves the wall points of one node by the factor that holds where they lie along the branch.
template <class Factor>
void widenPoints(const Case& value, bool isSac, double here, const Factor& factorAt,
                 std::uint32_t node, EditableCase& edited) {
  if (!value.points) return;
  const EditableNode& at = edited.nodes[node];
  const Vector3d centre = toEigen(at.centre);
  for (std::uint32_t k = value.points->offset[node]; k < value.points->offset[node + 1]; ++k) {
    const Vector3d p = toEigen(value.points->position[k]);
    const Polar polar(at, p);
    const double more = factorAt(isSac ? here : here + polar.along) - 1;
    edited.pointPosition[k] = toVec3f(p + more * (isSac ? Vector3d(p - centre) : polar.across));
  }
}

}  // namespace

Change widenAround(Case& target, std::uint32_t node, double radius, double reach) {
  requireNode(target, node);
  if (!isLength(radius) || !isLength(reach))
    throw invalidInput("found a radius of " + shownNumber(radius, 4) + " mm and a reach of " +
                       shownNumber(reach, 4) + " mm for " + nodeText(target, node) +
                       ", expected lengths above 0 and within a kilometre");
  const std::uint32_t b = target.tree.branch[node];
  const formats::Branch& branch = target.tree.branches[b];
  const std::vector<double> lengths = lengthsAlong(target.tree, branch);
  const double middle = lengths[node - branch.firstNode];
  const double factor = radius / double{target.tree.radius[node]};
  const auto factorAt = [&](double length) {
    return 1 + (factor - 1) * fading(std::abs(length - middle), reach);
  };
  EditableCase edited(target);
  if (target.points) edited.pointPosition = target.points->position;
  for (std::uint32_t i = 0; i < branch.nodeCount; ++i) {
    const std::uint32_t at = branch.firstNode + i;
    EditableNode& changed = edited.nodes[at];
    const double halfHeight = 0.5 * double{changed.height};
    if (std::abs(lengths[i] - middle) >= reach + halfHeight) continue;
    widenPoints(target, branch.kind == formats::BranchKind::Aneurysm, lengths[i], factorAt, at,
                edited);
    const double own = factorAt(lengths[i]);
    changed.radius = static_cast<float>(own * double{changed.radius});
    if (std::abs(own - 1) > kUnmoved) markEdited(changed);
  }
  edited.branches[b].isOther = true;
  return edited.finish(target, "gave " + nodeText(target, node) + " a radius of " +
                                   shownNumber(radius, 4) + " mm, fading over " +
                                   shownNumber(reach, 4) + " mm");
}

namespace {

/// The nodes to which at most `reach` mm lead from `node` along the tree.
std::vector<std::uint32_t> nodesNear(const formats::CenterlineTree& tree, std::uint32_t node,
                                     double reach) {
  std::vector<std::vector<std::uint32_t>> edges(tree.nodeCount());
  const auto join = [&edges](std::uint32_t a, std::uint32_t b) {
    edges[a].push_back(b);
    edges[b].push_back(a);
  };
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] >= 0) join(i, static_cast<std::uint32_t>(tree.parent[i]));
  for (const auto& [a, b] : tree.links) join(a, b);
  std::vector<double> away(tree.nodeCount(), HUGE_VAL);
  std::vector<std::uint32_t> found;
  std::deque<std::uint32_t> due{node};
  away[node] = 0;
  while (!due.empty()) {
    const std::uint32_t at = due.front();
    due.pop_front();
    if (std::find(found.begin(), found.end(), at) == found.end()) found.push_back(at);
    for (const std::uint32_t next : edges[at]) {
      const double length =
          away[at] + (toEigen(tree.centre[next]) - toEigen(tree.centre[at])).norm();
      if (length > reach || length >= away[next]) continue;
      away[next] = length;
      due.push_back(next);
    }
  }
  return found;
}

/// The place to which a stroke moves a wall point of a node.
Vector3d pushed(const EditableNode& node, const Vector3d& p, const Stroke& stroke) {
  Vector3d way = fading((p - stroke.at).norm(), stroke.radius) * stroke.by;
  const Polar polar(node, p);
  const double distance = polar.across.norm();
  const double inwards = distance > 0 ? -way.dot(polar.across) / distance : 0;
  const double most = (1 - kNearest) * distance;
  if (inwards > most) way *= most / inwards;
  return p + way;
}

/// Moves the wall points of a node by a stroke, and its radius with them; returns how many moved.
std::size_t pushPoints(const Case& value, std::uint32_t node, const Stroke& stroke,
                       EditableCase& edited) {
  EditableNode& at = edited.nodes[node];
  double before = 0, after = 0, farthest = 0;
  std::size_t moved = 0;
  for (std::uint32_t k = value.points->offset[node]; k < value.points->offset[node + 1]; ++k) {
    const Vector3d p = toEigen(value.points->position[k]), to = pushed(at, p, stroke);
    before += Polar(at, p).across.norm();
    after += Polar(at, to).across.norm();
    farthest = std::max(farthest, (to - p).norm());
    if (to == p) continue;
    edited.pointPosition[k] = toVec3f(to);
    ++moved;
  }
  if (moved > 0 && before > 0) at.radius = static_cast<float>(double{at.radius} * after / before);
  if (farthest > kUnmoved * double{at.radius}) markEdited(at);
  return moved;
}

}  // namespace

Change pushWall(Case& target, std::uint32_t node, const Stroke& stroke) {
  requireNode(target, node);
  if (!stroke.at.allFinite() || !isWithin(stroke.by, kFarthest) || !isLength(stroke.radius))
    throw invalidInput("found a brush of radius " + shownNumber(stroke.radius, 4) +
                       " mm that moves by " + vectorText(stroke.by) +
                       " mm, expected a radius above 0 and lengths within a kilometre");
  EditableCase edited(target);
  std::size_t moved = 0;
  if (target.points) {
    edited.pointPosition = target.points->position;
    const double reach = 2 * (stroke.radius + double{target.tree.radius[node]});
    for (const std::uint32_t near : nodesNear(target.tree, node, reach)) {
      const std::size_t count = pushPoints(target, near, stroke, edited);
      if (count > 0) edited.branches[target.tree.branch[near]].isOther = true;
      moved += count;
    }
  }
  if (moved == 0)
    throw invalidInput("the brush holds no wall point of " + nodeText(target, node) +
                       " or its neighbours; expected a place at their wall, or a wider brush");
  return edited.finish(target, "pushed the wall at " + nodeText(target, node) + " by " +
                                   shownNumber(stroke.by.norm(), 3) + " mm");
}

}  // namespace lumen::convert
