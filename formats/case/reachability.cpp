// SPDX-License-Identifier: Apache-2.0
#include "formats/case/reachability.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/case/topology.h"

namespace lumen::formats {
namespace {

/// Of the lesser radius: the length of a step, and the most steps along one edge, which bounds the
/// work where an edge is long and thin beyond reason.
constexpr double kStep = 0.125;
constexpr double kMostSteps = 4096;

field::Vec centreOf(const CenterlineTree& tree, std::uint32_t node) {
  const Vec3f& c = tree.centre[node];
  return {double{c.x}, double{c.y}, double{c.z}};
}

bool isInside(const field::BlendedField& field, const field::Vec& point, std::uint32_t cursor) {
  return field.blended<1>(point, cursor).value > field.level();
}

/// Where a push along one edge ended, and the places where it was outside.
struct Push {
  std::uint32_t cursor = 0;
  std::vector<ClosedPlace> closed;
};

Push pushAlong(const CenterlineTree& tree, const field::BlendedField& field, std::uint32_t node,
               std::uint32_t cursor) {
  const auto parent = static_cast<std::uint32_t>(tree.parent[node]);
  const field::Vec from = centreOf(tree, parent), to = centreOf(tree, node);
  const double length = std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
  const double radius = double{std::min(tree.radius[node], tree.radius[parent])};
  const double count = std::clamp(std::ceil(length / (kStep * radius)), 1.0, kMostSteps);
  Push push;
  push.cursor = cursor;
  for (double i = 1; i <= count; ++i) {
    const double t = i / count;
    const field::Vec p = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                          from.z + t * (to.z - from.z)};
    push.cursor = field.follow(p, push.cursor);
    if (!isInside(field, p, push.cursor)) push.closed.push_back({p, push.cursor});
  }
  return push;
}

}  // namespace

std::vector<std::vector<ClosedPlace>> closedPlacesOf(const CenterlineTree& tree,
                                                     const field::BlendedField& field) {
  const auto count = static_cast<std::uint32_t>(tree.nodeCount());
  std::vector<std::uint32_t> cursor(count);
  std::vector<std::vector<ClosedPlace>> closed(count);
  for (std::uint32_t node = 0; node < count; ++node) {
    if (tree.parent[node] != kNoParent) {
      const auto parent = static_cast<std::uint32_t>(tree.parent[node]);
      Push push = pushAlong(tree, field, node, cursor[parent]);
      cursor[node] = push.cursor;
      closed[node] = std::move(push.closed);
      if (closed[node].empty()) continue;
    }
    const field::Vec centre = centreOf(tree, node);
    cursor[node] = field.follow(centre, node);
    if (tree.parent[node] == kNoParent && !isInside(field, centre, cursor[node]))
      closed[node] = {{centre, cursor[node]}};
  }
  return closed;
}

Reachability reachabilityOf(const CenterlineTree& tree, const field::BlendedField& field) {
  constexpr std::uint32_t kOpen = field::kNowhere;
  const std::vector<std::vector<ClosedPlace>> closed = closedPlacesOf(tree, field);
  Reachability result;
  std::vector<std::uint32_t> barrier(closed.size(), kOpen);  // what keeps a node from its root
  for (std::uint32_t node = 0; node < closed.size(); ++node) {
    const bool isRoot = tree.parent[node] == kNoParent;
    const double length = edgeLength(tree, node);
    result.total += length;
    if (!isRoot) barrier[node] = barrier[static_cast<std::size_t>(tree.parent[node])];
    if (barrier[node] == kOpen && !closed[node].empty()) {
      barrier[node] = static_cast<std::uint32_t>(result.barriers.size());
      result.barriers.push_back({node, closed[node].front().place, 0});
    }
    if (barrier[node] == kOpen)
      result.reachable += length;
    else
      result.barriers[barrier[node]].beyond += length;
  }
  return result;
}

}  // namespace lumen::formats
