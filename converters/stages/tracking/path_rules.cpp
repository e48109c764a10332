// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/path_rules.h"

#include <algorithm>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Nodes: about two radii of path, over which a vessel hardly changes.
constexpr std::size_t kRecent = 8;

/// Of the radius: the least step. Few wall points make a short height, and a track must get on.
constexpr double kLeastStep = 0.25;
/// Of a step: how far a fit may move the centre along the axis; more would be another step.
constexpr double kSlack = 0.5;

/// Of the last radius: the chord that tells the course; shorter ones are as noisy as directions.
constexpr double kChord = 1.5;
/// Nodes at the start of a path that no chord begins at: they were fitted without a course.
constexpr std::size_t kUnsettled = 3;

/// Of the recent radius: a poor fit wider than this holds two vessels.
constexpr double kSwollen = 1.5;

/// Of a radius: a centre that is nearer to an earlier node is back in its lumen.
constexpr double kBack = 0.75;
/// Of the straight distance, beyond a radius: the longest way that a bend makes (half a circle is
/// pi/2 times its diameter).
constexpr double kBend = 1.5;

/// Most nodes that are dropped at a tip, the nodes whose mean radius they are compared with, and
/// how many times as wide they are: a rounded end is seen for a step or two.
constexpr std::size_t kTip = 3, kBeforeTip = 6;
constexpr double kTipWidth = 1.4;

}  // namespace

RecentMeans recentMeans(std::span<const TrackedNode> nodes) {
  const std::size_t count = std::min(nodes.size(), kRecent);
  RecentMeans mean;
  for (const TrackedNode& node : nodes.last(count)) {
    mean.inlierRate += node.inlierRate / static_cast<double>(count);
    mean.strength += node.strength / static_cast<double>(count);
    mean.radius += node.radius / static_cast<double>(count);
  }
  return mean;
}

NodeGuess predictNode(const TrackOptions& options, const TrackedNode& from, double steps,
                      const Vector3d& direction) {
  const double step = std::max(options.step * from.height, kLeastStep * from.radius);
  return {from.centre + steps * step * direction, direction, from.radius, true, kSlack * step};
}

Vector3d courseOf(std::span<const TrackedNode> nodes) {
  const TrackedNode& last = nodes.back();
  for (std::size_t i = nodes.size() - 1; i-- > kUnsettled;) {
    const Vector3d chord = last.centre - nodes[i].centre;
    if (chord.norm() >= kChord * last.radius)
      return (last.direction + chord.normalized()).normalized();
  }
  return last.direction;
}

bool isSwollen(const TrackOptions& options, std::span<const TrackedNode> nodes,
               const TrackedNode& next) {
  return next.inlierRate < options.inlierRate && next.radius > kSwollen * recentMeans(nodes).radius;
}

std::optional<std::size_t> findTurningPoint(std::span<const TrackedNode> nodes,
                                            const TrackedNode& next) {
  const Vector3d ahead = next.centre - nodes.back().centre;
  if (ahead.dot(nodes.back().direction) <= 0) return nodes.size();
  double way = ahead.norm(), farthest = 0;
  std::size_t turn = nodes.size();
  for (std::size_t i = nodes.size() - 1; i-- > 0;) {
    way += (nodes[i + 1].centre - nodes[i].centre).norm();
    const double distance = (next.centre - nodes[i].centre).norm();
    if (distance > farthest) {
      farthest = distance;
      turn = i;
    }
    if (distance < kBack * nodes[i].radius && way > kBend * distance + nodes[i].radius) return turn;
  }
  return std::nullopt;
}

void dropTip(std::vector<TrackedNode>& nodes) {
  for (std::size_t dropped = 0; dropped < kTip && nodes.size() > kBeforeTip + 2; ++dropped) {
    double radius = 0;
    for (std::size_t i = nodes.size() - 1 - kBeforeTip; i + 1 < nodes.size(); ++i)
      radius += nodes[i].radius / static_cast<double>(kBeforeTip);
    if (nodes.back().radius < kTipWidth * radius) return;
    nodes.pop_back();
  }
}

}  // namespace lumen::convert
