// SPDX-License-Identifier: Apache-2.0
#include "formats/case/reachability.h"

#include <algorithm>
#include <cmath>

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

double edgeLength(const CenterlineTree& tree, std::uint32_t node) {
  const field::Vec a = centreOf(tree, static_cast<std::uint32_t>(tree.parent[node]));
  const field::Vec b = centreOf(tree, node);
  return std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
}

bool isInside(const field::BlendedField& field, const field::Vec& point, std::uint32_t cursor) {
  return field.blended<1>(point, cursor).value > field.level();
}

/// True if a cursor at `cursor` answers for `node`.
bool hasArrived(const field::BlendedField& field, std::uint32_t cursor, std::uint32_t node) {
  const auto around = field.neighbours(node);
  return cursor == node || std::binary_search(around.begin(), around.end(), cursor);
}

/// Where a push along one edge ended, and the places where it was outside.
struct Push {
  std::uint32_t cursor = 0;
  double step = 0;  ///< mm
  std::vector<ClosedPlace> closed;
};

Push pushAlong(const CenterlineTree& tree, const field::BlendedField& field, std::uint32_t node,
               std::uint32_t cursor) {
  const auto parent = static_cast<std::uint32_t>(tree.parent[node]);
  const field::Vec from = centreOf(tree, parent), to = centreOf(tree, node);
  const double length = edgeLength(tree, node);
  const double radius = double{std::min(tree.radius[node], tree.radius[parent])};
  const double count = std::clamp(std::ceil(length / (kStep * radius)), 1.0, kMostSteps);
  Push push;
  push.cursor = cursor;
  push.step = length / count;
  for (double i = 1; i <= count; ++i) {
    const double t = i / count;
    const field::Vec p = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                          from.z + t * (to.z - from.z)};
    push.cursor = field.follow(p, push.cursor);
    if (!isInside(field, p, push.cursor)) push.closed.push_back({p, push.cursor});
  }
  if (push.closed.empty() && !hasArrived(field, push.cursor, node))
    push.closed.push_back({to, push.cursor});
  return push;
}

}  // namespace

std::vector<ClosedPlace> closedPlaces(const CenterlineTree& tree, const field::BlendedField& field,
                                      std::uint32_t node) {
  if (tree.parent[node] != kNoParent) {
    const auto parent = static_cast<std::uint32_t>(tree.parent[node]);
    return pushAlong(tree, field, node, field.follow(centreOf(tree, parent), parent)).closed;
  }
  const field::Vec start = centreOf(tree, node);
  const std::uint32_t cursor = field.follow(start, node);
  if (isInside(field, start, cursor)) return {};
  return {{start, cursor}};
}

Reachability reachabilityOf(const CenterlineTree& tree, const field::BlendedField& field) {
  constexpr std::uint32_t kOpen = field::kNowhere;
  Reachability result;
  const std::size_t count = tree.nodeCount();
  std::vector<std::uint32_t> cursor(count);
  std::vector<std::uint32_t> barrier(count, kOpen);  // the one that keeps a node from its root
  for (std::uint32_t node = 0; node < count; ++node) {
    if (tree.parent[node] == kNoParent) {
      const field::Vec start = centreOf(tree, node);
      cursor[node] = field.follow(start, node);
      if (isInside(field, start, cursor[node])) continue;
      barrier[node] = static_cast<std::uint32_t>(result.barriers.size());
      result.barriers.push_back({node, start, 0, 0});
      continue;
    }
    const auto parent = static_cast<std::uint32_t>(tree.parent[node]);
    const double length = edgeLength(tree, node);
    result.total += length;
    barrier[node] = barrier[parent];
    if (barrier[node] == kOpen) {
      const Push push = pushAlong(tree, field, node, cursor[parent]);
      cursor[node] = push.cursor;
      if (push.closed.empty()) {
        result.reachable += length;
        continue;
      }
      barrier[node] = static_cast<std::uint32_t>(result.barriers.size());
      result.barriers.push_back({node, push.closed.front().place,
                                 push.step * static_cast<double>(push.closed.size()), 0});
    }
    result.barriers[barrier[node]].beyond += length;
  }
  return result;
}

}  // namespace lumen::formats
