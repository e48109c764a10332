// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/look_ahead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/path_rules.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Of the recent means: the least inlier rate and strength beyond a gap. What is found must be
/// nearly as good a cylinder as the vessel was; its contrast may fall by more.
constexpr double kLikeRate = 0.8, kLikeStrength = 0.5;
/// Of the last radius: how wide the vessel may be beyond a gap. Narrowing is usual, growing is not.
constexpr double kNarrowest = 0.6, kWidest = 1.5;
/// Recent radii: a gap that is shorter is bridged whatever direction the vessel has beyond it.
constexpr double kShortGap = 2.0;
/// Cosine of 40 degrees, the most that a vessel beyond a gap may run across the way to it; and of
/// 50, the most that it may turn. Another vessel that passes by runs across.
constexpr double kOnCourse = 0.77, kMostTurn = 0.64;
/// Directions around the last one that are tried, and the tangent of their angle to it.
constexpr int kSides = 6;
constexpr double kTilt = 0.5;
/// Nodes that are given up, by turns. A track goes astray for a node or a few.
constexpr std::array<std::size_t, 3> kGivenUp = {0, 3, 6};

/// What a vessel so far asks of nodes beyond a gap.
struct Likeness {
  const TrackedNode& last;
  RecentMeans mean;

  [[nodiscard]] bool holds(const TrackedNode& node) const {
    return node.strength >= kLikeStrength * mean.strength &&
           node.radius >= kNarrowest * last.radius && node.radius <= kWidest * last.radius;
  }
  [[nodiscard]] bool onCourse(const TrackedNode& node) const {
    const Vector3d way = node.centre - last.centre;
    return way.norm() < kShortGap * mean.radius ||
           (way.normalized().dot(node.direction) > kOnCourse &&
            last.direction.dot(node.direction) > kMostTurn);
  }
};

/// The last direction, or one tilted from it to a side in 1 .. kSides.
Vector3d directionTo(int side, const Vector3d& straight) {
  if (side == 0) return straight;
  const auto [e1, e2] = planeBasis(straight);
  const double angle = std::numbers::pi / 3.0 * side;
  const Vector3d aside = std::cos(angle) * e1 + std::sin(angle) * e2;
  return Vector3d(straight + kTilt * aside).normalized();
}

/// Two consecutive nodes from a guess on; empty if they are not this vessel's.
std::vector<TrackedNode> fitPair(const TrackContext& context, std::span<const TrackedNode> nodes,
                                 const Likeness& like, const NodeGuess& guess, Random& random,
                                 TrackWorkspace& workspace) {
  const double minRate =
      std::max(leastInlierRate(context.options), kLikeRate * like.mean.inlierRate);
  std::optional<TrackedNode> first = fitNode(context, guess, minRate, random, workspace).node;
  if (!first || !like.holds(*first) || findTurningPoint(nodes, *first)) return {};
  const NodeGuess next = predictNode(context.options, *first, 1, first->direction);
  std::optional<TrackedNode> second = fitNode(context, next, minRate, random, workspace).node;
  if (!second || !like.holds(*second) || !like.onCourse(*second) ||
      findTurningPoint(std::array{like.last, *first}, *second))
    return {};
  return {std::move(*first), std::move(*second)};
}

/// The two nodes of the nearest place ahead of a path that it may go on to; empty if there is none.
std::vector<TrackedNode> lookAhead(const TrackContext& context, std::span<const TrackedNode> nodes,
                                   Random& random, TrackWorkspace& workspace) {
  const Likeness like{nodes.back(), recentMeans(nodes)};
  for (int steps = 1; steps <= context.options.lookAhead; ++steps)
    for (int side = 0; side <= kSides; ++side) {
      context.progress.check();
      const Vector3d direction = directionTo(side, like.last.direction);
      const NodeGuess guess = predictNode(context.options, like.last, steps, direction);
      std::vector<TrackedNode> pair = fitPair(context, nodes, like, guess, random, workspace);
      if (!pair.empty()) return pair;
    }
  return {};
}

}  // namespace

Continuation findContinuation(const TrackContext& context, std::span<const TrackedNode> nodes,
                              bool mayGiveUp, Random& random, TrackWorkspace& workspace) {
  for (const std::size_t back : kGivenUp) {
    if (back > 0 && (!mayGiveUp || nodes.size() < back + 2)) break;
    const std::size_t kept = nodes.size() - back;
    std::vector<TrackedNode> found = lookAhead(context, nodes.first(kept), random, workspace);
    if (!found.empty()) return {kept, std::move(found)};
  }
  return {nodes.size(), {}};
}

}  // namespace lumen::convert
