// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/inlets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/selection.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

/// Radii up to this many times the least belong to the narrowest stretch of a path.
constexpr double kNarrowShare = 1.1;

std::vector<std::vector<std::uint32_t>> findChildren(const CenterlineTree& tree) {
  std::vector<std::vector<std::uint32_t>> children(tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] != formats::kNoParent)
      children[static_cast<std::size_t>(tree.parent[i])].push_back(i);
  return children;
}

/// The end of the tree of `from` that is nearest along the vessels: its root, or a tip.
std::uint32_t nearestEnd(const CenterlineTree& tree, std::uint32_t from) {
  const auto children = findChildren(tree);
  std::vector<double> away(tree.nodeCount(), -1);
  std::vector<std::uint32_t> reached{from};
  away[from] = 0;
  std::uint32_t best = from;
  double least = std::numeric_limits<double>::infinity();
  const auto reach = [&](std::uint32_t node, std::uint32_t before) {
    if (away[node] >= 0) return;
    away[node] = away[before] + (toEigen(tree.centre[node]) - toEigen(tree.centre[before])).norm();
    reached.push_back(node);
  };
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const std::uint32_t node = reached[k];
    const bool isRoot = tree.parent[node] == formats::kNoParent;
    if ((isRoot || children[node].empty()) && away[node] < least) {
      best = node;
      least = away[node];
    }
    if (!isRoot) reach(static_cast<std::uint32_t>(tree.parent[node]), node);
    for (const std::uint32_t child : children[node]) reach(child, node);
  }
  return best;
}

std::uint32_t indexAfter(const Change& change, std::uint32_t before) {
  return static_cast<std::uint32_t>(std::find(change.before.begin(), change.before.end(), before) -
                                    change.before.begin());
}

/// Makes a tip the root of its tree.
Change turn(formats::Case& target, std::uint32_t tip) {
  const std::uint32_t branch = target.tree.branch[tip];
  const bool isFirst = target.tree.branches[branch].parentNode == formats::kNoParent;
  return isFirst ? reverseBranch(target, branch) : makeRoot(target, branch);
}

/// The node before which to cut the path between a tip and its root: in the middle of the narrowest
/// stretch, as radii of a communicating artery differ by their error alone; empty if there is none.
std::optional<std::uint32_t> placeToCut(const CenterlineTree& tree, std::uint32_t tip) {
  std::vector<std::uint32_t> path;
  std::vector<double> at;  // mm from the tip
  for (std::uint32_t i = tip; tree.parent[i] != formats::kNoParent;
       i = static_cast<std::uint32_t>(tree.parent[i])) {
    at.push_back(path.empty()
                     ? 0
                     : at.back() +
                           (toEigen(tree.centre[i]) - toEigen(tree.centre[path.back()])).norm());
    path.push_back(i);
  }
  const auto isPlace = [&](std::size_t k) {
    return k > 0 && path[k] != tree.branches[tree.branch[path[k]]].firstNode;
  };
  std::optional<std::size_t> narrowest;
  for (std::size_t k = 0; k < path.size(); ++k)
    if (isPlace(k) && (!narrowest || tree.radius[path[k]] < tree.radius[path[*narrowest]]))
      narrowest = k;
  if (!narrowest) return std::nullopt;
  const double most = kNarrowShare * double{tree.radius[path[*narrowest]]};
  std::size_t first = *narrowest, last = *narrowest;
  while (first > 0 && double{tree.radius[path[first - 1]]} <= most) --first;
  while (last + 1 < path.size() && double{tree.radius[path[last + 1]]} <= most) ++last;
  const double middle = 0.5 * (at[first] + at[last]);
  std::size_t best = *narrowest;
  for (std::size_t k = first; k <= last; ++k)
    if (isPlace(k) && std::abs(at[k] - middle) < std::abs(at[best] - middle)) best = k;
  return path[best];
}

/// Cuts a tree between its root and a tip, makes the tip a root, and links both parts. False if
/// there is no place to cut.
bool divide(formats::Case& target, std::uint32_t tip) {
  const auto place = placeToCut(target.tree, tip);
  if (!place) return false;
  const Change cut = cutBefore(target, *place, Rest::OwnTree);
  const std::uint32_t near = indexAfter(cut, *place - 1), far = indexAfter(cut, *place);
  const Change turned = turn(target, indexAfter(cut, tip));
  const std::uint32_t a = indexAfter(turned, near), b = indexAfter(turned, far);
  target.tree.links.push_back({std::min(a, b), std::max(a, b)});
  std::sort(target.tree.links.begin(), target.tree.links.end());
  return true;
}

/// Distance over radius from a point to the stretch between a branch's parent and its first node,
/// outside of the parent's ball: a vessel begins at the wall that it leaves. Infinite without one.
double shareBeforeFirst(const CenterlineTree& tree, const formats::Branch& record,
                        const Vector3d& point) {
  if (record.parentNode == formats::kNoParent) return std::numeric_limits<double>::infinity();
  const auto parent = static_cast<std::size_t>(record.parentNode);
  const Vector3d from = toEigen(tree.centre[parent]), to = toEigen(tree.centre[record.firstNode]);
  const double length = (to - from).norm(), wall = double{tree.radius[parent]};
  if (length <= wall) return std::numeric_limits<double>::infinity();
  const Vector3d along = (to - from) / length;
  const double t = std::clamp((point - from).dot(along), wall, length);
  return (from + t * along - point).norm() / double{tree.radius[record.firstNode]};
}

}  // namespace

std::optional<NodePlace> placeIn(const CenterlineTree& tree, std::uint32_t branch,
                                 const Vector3d& point) {
  std::optional<NodePlace> best;
  const formats::Branch& record = tree.branches[branch];
  const double first = shareBeforeFirst(tree, record, point);
  if (first <= 1) best = NodePlace{branch, record.firstNode, first};
  for (std::uint32_t n = record.firstNode; n < record.firstNode + record.nodeCount; ++n) {
    const double share = (toEigen(tree.centre[n]) - point).norm() / double{tree.radius[n]};
    if (share <= (best ? best->share : 1)) best = NodePlace{branch, n, share};
  }
  return best;
}

std::optional<NodePlace> placeIn(const CenterlineTree& tree, const Vector3d& point) {
  std::optional<NodePlace> best;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    if (tree.branches[b].kind != formats::BranchKind::Vessel) continue;
    const auto place = placeIn(tree, b, point);
    if (place && (!best || place->share < best->share)) best = place;
  }
  return best;
}

std::uint32_t rootAbove(const CenterlineTree& tree, std::uint32_t node) {
  while (tree.parent[node] != formats::kNoParent)
    node = static_cast<std::uint32_t>(tree.parent[node]);
  return node;
}

std::optional<NearVessel> nearestVessel(const CenterlineTree& tree, const Vector3d& point) {
  std::optional<NearVessel> best;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    if (tree.branches[tree.branch[n]].kind != formats::BranchKind::Vessel) continue;
    const double toWall = (toEigen(tree.centre[n]) - point).norm() - double{tree.radius[n]};
    if (!best || toWall < best->toWall) best = NearVessel{tree.branch[n], toWall};
  }
  return best;
}

std::string reasonFor(UnusedPlace::Why why) {
  switch (why) {
    case UnusedPlace::Why::InNoVessel:
      return "it lies in no vessel";
    case UnusedPlace::Why::SameEnd:
      return "an earlier root has the end that is nearest to it, along the vessels";
    case UnusedPlace::Why::NotDivided:
      return "blood comes into its tree at an earlier root, and no node lies between both at which "
             "the tree could be divided";
  }
  return {};
}

std::vector<UnusedPlace> beginAt(formats::Case& target, std::span<const Vector3d> places) {
  std::vector<UnusedPlace> unused;
  std::vector<formats::Vec3f> inlets;  // centres, as indices change
  const auto isInlet = [&](std::uint32_t node) {
    return std::find(inlets.begin(), inlets.end(), target.tree.centre[node]) != inlets.end();
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto place = placeIn(target.tree, places[i]);
    if (!place) {
      unused.push_back({i, UnusedPlace::Why::InNoVessel});
      continue;
    }
    const std::uint32_t end = nearestEnd(target.tree, place->node);
    const std::uint32_t root = rootAbove(target.tree, place->node);
    const formats::Vec3f centre = target.tree.centre[end];
    if (end == root && isInlet(root)) {
      unused.push_back({i, UnusedPlace::Why::SameEnd});
      continue;
    }
    if (end != root && !isInlet(root)) {
      turn(target, end);
    } else if (end != root && !divide(target, end)) {
      unused.push_back({i, UnusedPlace::Why::NotDivided});
      continue;
    }
    inlets.push_back(centre);
  }
  return unused;
}

}  // namespace lumen::convert
