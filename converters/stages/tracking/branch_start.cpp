// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/branch_start.h"

#include <algorithm>
#include <span>
#include <utility>

#include "converters/stages/tracking/follow.h"
#include "converters/stages/tracking/onward.h"
#include "converters/stages/tracking/path_rules.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Voxels: the first trial radius at a click, the bound on them, and the ratio of one to the next.
/// A cylinder is found if its radius is between a half and three halves of the trial's.
constexpr double kFirstTrial = 1.25, kLastTrial = 24, kTrialRatio = 1.5;
/// Of the rays: a start whose wall more of them see needs no larger trial.
constexpr double kSeenWall = 0.5;

/// Of the parent's radius: a start nearer to its axis is in its lumen.
constexpr double kInLumen = 0.75;
/// Offsets from the parent's axis beyond which a click is far: the child is tracked back from it.
constexpr double kFarClick = 2.0;
/// Trial radii of a child: shares of the user's radius, which is an estimate, or of the parent's,
/// which is an upper bound.
constexpr double kAroundEstimate[] = {1.0, 0.7, 1.4};
constexpr double kBelowBound[] = {1.0, 0.7, 0.5, 0.35, 0.25};

/// A node from one of several guesses, each with several radii: the first that leads on and is not
/// in the lumen of `parent`, else the one that goes on farthest; well fitted ones before others.
BranchStart startBeside(const TrackContext& context, const TrackedBranch& parent,
                        std::span<const NodeGuess> guesses, std::span<const double> radii,
                        Random& random, TrackWorkspace& workspace) {
  const double accepted = context.options.inlierRate, least = leastInlierRate(context.options);
  BranchStart start;
  int mostSteps = -1;
  for (const double minRate : {accepted, least})
    for (NodeGuess guess : guesses)
      for (const double radius : radii) {
        guess.radius = radius;
        NodeFit fit = fitNode(context, guess, minRate, random, workspace);
        if (!fit.node) {
          // the first round asks for more than what is needed
          if (minRate == least && isNearer(fit, start.best)) start.best = std::move(fit);
          continue;
        }
        const ChainPoint nearest = closestOnChain(parent.nodes, fit.node->centre);
        if (nearest.distance < kInLumen * nearest.radius) {
          start.inParent = true;
          continue;
        }
        const int steps = stepsFrom(context, *fit.node, &parent, random, workspace);
        if (steps > mostSteps) {
          mostSteps = steps;
          start.nodes.assign(1, std::move(*fit.node));
        }
        if (steps == kTrialSteps) return start;
      }
  return start;
}

/// Radii to try, mm, for a child with a click beside a parent of that radius.
std::vector<double> trialRadii(const SeedPoint& click, double parentRadius) {
  const double radius = click.radius.value_or(parentRadius);
  const std::span<const double> shares = click.radius ? std::span<const double>(kAroundEstimate)
                                                      : std::span<const double>(kBelowBound);
  std::vector<double> radii;
  for (const double share : shares) radii.push_back(share * radius);
  return radii;
}

}  // namespace

int stepsFrom(const TrackContext& context, const TrackedNode& start, const TrackedBranch* parent,
              Random& random, TrackWorkspace& workspace) {
  const std::span others(&parent, parent ? 1 : 0);
  const TrackOptions& options = context.options;
  std::vector<TrackedNode> nodes{start};
  for (int step = 0; step < kTrialSteps; ++step) {
    const NodeGuess guess = predictNode(options, nodes.back(), 1, nodes.back().direction);
    auto next = fitNode(context, guess, leastInlierRate(options), random, workspace).node;
    if (!next || isSwollen(options, nodes, *next) || findTurningPoint(nodes, *next) ||
        inCore(others, *next))
      return step;
    nodes.push_back(std::move(*next));
  }
  return kTrialSteps;
}

std::optional<Vector3d> directionOf(const SeedBranch& seed) {
  if (seed.direction) return seed.direction;
  if (seed.points.size() < 2) return std::nullopt;
  return (seed.points[1].position - seed.points[0].position).normalized();
}

BranchStart startAtClick(const TrackContext& context, const SeedPoint& click,
                         const Vector3d& direction, bool smooth, Random& random,
                         TrackWorkspace& workspace) {
  std::vector<double> radii;
  if (click.radius)
    radii = {*click.radius};
  else
    for (double voxels = kFirstTrial; voxels < kLastTrial; voxels *= kTrialRatio)
      radii.push_back(voxels * context.volume.geometry().voxelSize());
  BranchStart start;
  for (const double radius : radii) {
    NodeFit fit = fitNode(context, {click.position, direction, radius, smooth},
                          leastInlierRate(context.options), random, workspace);
    if (!fit.node) {
      if (isNearer(fit, start.best)) start.best = std::move(fit);
      continue;
    }
    if (!start.nodes.empty() && fit.node->inlierRate <= start.nodes[0].inlierRate) continue;
    start.nodes.assign(1, std::move(*fit.node));
    const TrackedNode& best = start.nodes[0];
    if (best.inlierRate >= context.options.inlierRate &&
        static_cast<double>(best.points.size()) >
            kSeenWall * static_cast<double>(context.rays.size()))
      break;
  }
  return start;
}

BranchStart startChild(const TrackContext& context, const SeedBranch& seed,
                       const TrackedBranch& parent, Random& random, TrackWorkspace& workspace) {
  const SeedPoint& click = seed.points[0];
  const ChainPoint root = closestOnChain(parent.nodes, click.position);
  const Vector3d toClick = root.distance > 0
                               ? Vector3d((click.position - root.position) / root.distance)
                               : parent.nodes[root.node].direction;
  const Vector3d outward = seed.direction.value_or(toClick);
  const double offset = context.options.branchOffset;
  const NodeGuess atParent{root.position + offset * root.radius * outward, outward};
  const NodeGuess atClick{click.position, directionOf(seed).value_or(toClick), 0,
                          directionOf(seed).has_value()};
  const bool far = root.distance > kFarClick * offset * root.radius;
  std::vector<NodeGuess> guesses{atParent, atClick};
  if (far) std::swap(guesses[0], guesses[1]);
  BranchStart start =
      startBeside(context, parent, guesses, trialRadii(click, root.radius), random, workspace);
  start.parentNode = static_cast<int>(root.node);
  if (!far || start.nodes.empty()) return start;
  start.nodes = trackBack(context, start.nodes[0], parent, random, workspace);
  const ChainPoint end = closestOnChain(parent.nodes, start.nodes.front().centre);
  start.parentNode = static_cast<int>(end.node);
  return start;
}

BranchStart startNearby(const TrackContext& context, const SeedPoint& click,
                        const TrackedBranch* parent, Random& random, TrackWorkspace& workspace) {
  std::vector<Ball> taken;
  if (parent) addBalls(parent->nodes, context.volume.geometry(), taken);
  BranchStart start;
  for (const NearbyPlace& place : placesAround(context, click.position, taken)) {
    BranchStart there = startAtClick(context, {place.position, click.radius}, place.direction, true,
                                     random, workspace);
    if (there.nodes.empty()) continue;
    const TrackedNode& node = there.nodes[0];
    if (parent) {
      const ChainPoint nearest = closestOnChain(parent->nodes, node.centre);
      if (nearest.distance < kInLumen * nearest.radius) continue;
    }
    if (node.inlierRate < context.options.inlierRate ||
        stepsFrom(context, node, parent, random, workspace) < kTrialSteps)
      continue;
    start.nodes = std::move(there.nodes);
    break;
  }
  if (parent)
    start.parentNode = static_cast<int>(closestOnChain(parent->nodes, click.position).node);
  return start;
}

}  // namespace lumen::convert
