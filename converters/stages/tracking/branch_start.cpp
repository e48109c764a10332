// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/branch_start.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "converters/stages/tracking/cylinders/smoothing.h"
#include "converters/stages/tracking/lumen_paths.h"
#include "converters/stages/tracking/track_steps.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The first trial radius at a click and the bound on them, in voxels, and the ratio of one to the
/// next. A cylinder is found if its radius is between a half and three halves of the trial's.
constexpr double kFirstTrialVoxels = 1.25, kLastTrialVoxels = 24, kTrialRatio = 1.5;

/// A start nearer to the parent's axis than this share of its radius is in its lumen.
constexpr double kInLumenShare = 0.75;
/// Offsets from the parent's axis beyond which a click is far: the child is tracked back from it.
constexpr double kFarClickOffsets = 2.0;
/// Trial radii of a child: shares of the user's radius, which is an estimate, or of the parent's,
/// which is an upper bound.
constexpr double kAroundEstimate[] = {1.0, 0.7, 1.4};
constexpr double kBelowBound[] = {1.0, 0.7, 0.5, 0.35, 0.25};

/// Voxels of path around a click, by turns, and the shares of it at which places are tried.
constexpr double kAroundVoxels[] = {6, 12};
constexpr double kPlaceShares[] = {1.0 / 3, 2.0 / 3, 1};

bool isInLumen(const TrackedBranch& parent, const TrackedNode& node) {
  const ChainPoint nearest = closestOnChain(parent.nodes, node.centre);
  return nearest.distance < kInLumenShare * nearest.radius;
}

/// A node from one of several guesses, each with several radii: the first that leads on and is not
/// in the lumen of `parent`, else the one whose track is longest; well fitted ones before others.
BranchStart startBeside(TrackRun& run, const TrackedBranch& parent,
                        std::span<const NodeGuess> guesses, std::span<const double> radii) {
  const TrackOptions& options = run.context.options;
  const double accepted = options.inlierRate, least = leastInlierRate(options);
  BranchStart start;
  int mostSteps = -1;
  for (const double minRate : {accepted, least})
    for (NodeGuess guess : guesses)
      for (const double radius : radii) {
        guess.radius = radius;
        NodeFit fit = fitNode(run, guess, minRate);
        if (!fit.node) {
          // the first round asks for more than is needed
          if (minRate == least && isNearer(fit, start.best)) start.best = std::move(fit);
          continue;
        }
        if (isInLumen(parent, *fit.node)) {
          start.inParent = true;
          continue;
        }
        const int steps = trialSteps(run, *fit.node, &parent);
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

LumenLevels levelsAtClick(const TrackContext& context, const Vector3d& click) {
  SeedBranch seed;
  seed.points.push_back({click, std::nullopt});
  const double contrast =
      contrastAtClicks(context.volume, {seed}, context.options, context.progress);
  const double value = context.volume.sample(context.volume.geometry().indexFromWorld(click));
  return {value, value - (context.options.dark ? -0.5 : 0.5) * contrast};
}

/// A place near a click at which nothing fits, and the direction of the lumen there (unit, away
/// from the click).
struct NearbyPlace {
  Vector3d position, direction;
};

/// Places along the lumen around a click, in all directions, the nearest first, outside of
/// `parent`, which may be null.
std::vector<NearbyPlace> placesNearby(const TrackContext& context, const Vector3d& click,
                                      const TrackedBranch* parent) {
  if (!context.volume.geometry().containsWorld(click)) return {};
  const LumenLevels levels = levelsAtClick(context, click);
  PathStart from;
  from.place = click;
  if (parent) addLumen(parent->nodes, context.volume.geometry(), from.closed);
  std::vector<NearbyPlace> places;
  for (const double voxels : kAroundVoxels) {
    const PathsBeyond beyond =
        pathsBeyond(context, levels, from, voxels * context.volume.geometry().voxelSize());
    for (const double share : kPlaceShares)
      for (const Path& path : beyond.paths) {
        const auto last = static_cast<double>(path.points.size() - 1);
        const auto at = static_cast<std::size_t>(std::round(share * last));
        if (at == 0) continue;
        const Vector3d ahead = path.points[at] - path.points[at / 2];
        if (ahead.norm() > 0) places.push_back({path.points[at], ahead.normalized()});
      }
  }
  return places;
}

}  // namespace

std::optional<Vector3d> statedDirection(const SeedBranch& seed) {
  if (seed.direction) return seed.direction;
  if (seed.points.size() < 2) return std::nullopt;
  return (seed.points[1].position - seed.points[0].position).normalized();
}

BranchStart startAtClick(TrackRun& run, const SeedPoint& click, const Vector3d& direction,
                         bool smooth) {
  const TrackContext& context = run.context;
  std::vector<double> radii;
  if (click.radius)
    radii = {*click.radius};
  else
    for (double voxels = kFirstTrialVoxels; voxels < kLastTrialVoxels; voxels *= kTrialRatio)
      radii.push_back(voxels * context.volume.geometry().voxelSize());
  BranchStart start;
  for (const double radius : radii) {
    NodeFit fit =
        fitNode(run, {click.position, direction, radius, smooth}, leastInlierRate(context.options));
    if (!fit.node) {
      if (isNearer(fit, start.best)) start.best = std::move(fit);
      continue;
    }
    if (!start.nodes.empty() && fit.node->inlierRate <= start.nodes[0].inlierRate) continue;
    start.nodes.assign(1, std::move(*fit.node));
    const TrackedNode& best = start.nodes[0];
    if (best.inlierRate >= context.options.inlierRate &&
        static_cast<double>(best.points.size()) >
            kSeenWallShare * static_cast<double>(context.rays.size()))
      break;
  }
  return start;
}

BranchStart startChild(TrackRun& run, const SeedBranch& seed, const TrackedBranch& parent) {
  const SeedPoint& click = seed.points[0];
  const ChainPoint root = closestOnChain(parent.nodes, click.position);
  const Vector3d toClick = root.distance > 0
                               ? Vector3d((click.position - root.position) / root.distance)
                               : parent.nodes[root.node].direction;
  const Vector3d outward = seed.direction.value_or(toClick);
  const double offset = run.context.options.branchOffset;
  const NodeGuess atParent{root.position + offset * root.radius * outward, outward};
  const NodeGuess atClick{click.position, statedDirection(seed).value_or(toClick), 0,
                          statedDirection(seed).has_value()};
  const bool far = root.distance > kFarClickOffsets * offset * root.radius;
  std::vector<NodeGuess> guesses{atParent, atClick};
  if (far) std::swap(guesses[0], guesses[1]);
  BranchStart start = startBeside(run, parent, guesses, trialRadii(click, root.radius));
  start.parentNode = static_cast<int>(root.node);
  if (!far || start.nodes.empty()) return start;
  start.nodes = trackBackTo(run, start.nodes[0], parent);
  const ChainPoint end = closestOnChain(parent.nodes, start.nodes.front().centre);
  start.parentNode = static_cast<int>(end.node);
  return start;
}

BranchStart startNearby(TrackRun& run, const SeedPoint& click, const TrackedBranch* parent) {
  BranchStart start;
  for (const NearbyPlace& place : placesNearby(run.context, click.position, parent)) {
    BranchStart there = startAtClick(run, {place.position, click.radius}, place.direction, true);
    if (there.nodes.empty()) continue;
    const TrackedNode& node = there.nodes[0];
    if (parent && isInLumen(*parent, node)) continue;
    if (node.inlierRate < run.context.options.inlierRate ||
        trialSteps(run, node, parent) < kTrialSteps)
      continue;
    start.nodes = std::move(there.nodes);
    break;
  }
  if (parent)
    start.parentNode = static_cast<int>(closestOnChain(parent->nodes, click.position).node);
  return start;
}

}  // namespace lumen::convert
