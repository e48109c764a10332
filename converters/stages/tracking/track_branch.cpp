// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_branch.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "converters/stages/tracking/branch_start.h"
#include "converters/stages/tracking/track_steps.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// A branch that starts farther from its parent's axis than this many of the parent's radii may
/// point in the wrong direction.
constexpr double kBesideRadii = 2.5;
/// A tip nearer to the parent than this share of the first node's distance is the branch's start.
constexpr double kWrongEndShare = 0.5;
/// A track that stays within this many radii of its click has died where it began.
constexpr double kStuntedRadii = 4;

BranchStart startAtSeed(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent) {
  if (parent) return startChild(run, seed, *parent);
  const auto direction = statedDirection(seed);
  return startAtClick(run, seed.points[0], direction.value_or(Vector3d::UnitZ()),
                      direction.has_value());
}

/// The reason why a branch cannot continue from its start; empty if it can.
std::string findFailure(const TrackContext& context, const BranchStart& start,
                        FinishedBranches finished) {
  if (start.nodes.empty())
    return start.inParent ? "what fits at the seed lies in its parent's lumen; click farther along "
                            "the branch, and give its radius if it is thin"
                          : "at the seed " + failureText(context, start.best);
  if (inCore(finished, start.nodes.back())) return kTrackedAlready;
  return {};
}

/// Leads a track through a further click that it may have missed: tracks from there back to the
/// track, drops the nodes beyond the place of meeting, and continues from the click. Returns the
/// reason if nothing fits at the click; else an empty text.
std::string trackThroughClick(TrackRun& run, const SeedPoint& click, TrackedBranch& branch,
                              FinishedBranches finished) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  const ChainPoint closest = closestOnChain(nodes, click.position);
  if (closest.distance <= closest.radius) return {};
  const Vector3d away = (click.position - closest.position) / closest.distance;
  const BranchStart start = startAtClick(run, click, away, false);
  if (start.nodes.empty()) return failureText(run.context, start.best);
  std::vector<TrackedNode> between = trackBackTo(run, start.nodes[0], branch);
  nodes.resize(closestOnChain(nodes, between.front().centre).node + 1);
  std::move(between.begin(), between.end(), std::back_inserter(nodes));
  trackToEnd(run, branch, finished);
  return {};
}

/// Continues from a branch's first node, against its direction.
void trackFromFirstNode(TrackRun& run, TrackedBranch& branch, FinishedBranches finished) {
  turnRound(branch);
  trackToEnd(run, branch, finished);
  turnRound(branch);
}

/// True if a branch that began away from its parent has run towards it.
bool looksBack(const TrackedBranch& parent, const TrackedBranch& branch) {
  const ChainPoint first = closestOnChain(parent.nodes, branch.nodes.front().centre);
  const ChainPoint last = closestOnChain(parent.nodes, branch.nodes.back().centre);
  return first.distance > kBesideRadii * first.radius &&
         last.distance < kWrongEndShare * first.distance;
}

/// The track from one start, in both directions where it has no parent.
TrackedBranch trackFromStart(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent,
                             BranchStart start, FinishedBranches finished) {
  TrackedBranch branch;
  branch.parentNode = start.parentNode;
  branch.failure = findFailure(run.context, start, finished);
  if (!branch.failure.empty()) return branch;
  branch.nodes = std::move(start.nodes);
  branch.clickNode = branch.nodes.size() - 1;
  if (!parent && !seed.direction) trackFromFirstNode(run, branch, finished);
  trackToEnd(run, branch, finished);
  if (parent && looksBack(*parent, branch)) {
    turnRound(branch);
    trackToEnd(run, branch, finished);
  }
  return branch;
}

/// True for a track that died where it began.
bool isStunted(const TrackedBranch& branch) {
  if (branch.nodes.empty()) return true;
  const TrackedNode& click = branch.nodes[std::min(branch.clickNode, branch.nodes.size() - 1)];
  return std::all_of(branch.nodes.begin(), branch.nodes.end(), [&](const TrackedNode& node) {
    return (node.centre - click.centre).norm() < kStuntedRadii * click.radius;
  });
}

/// Tracks a stunted branch anew, in the other direction and then from places near its click, and
/// keeps the longest track.
void trackStuntedAnew(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent,
                      FinishedBranches finished, TrackedBranch& branch) {
  if (!branch.nodes.empty()) {
    TrackedBranch other = branch;
    turnRound(other);
    trackToEnd(run, other, finished);
    if (other.nodes.size() > branch.nodes.size()) branch = std::move(other);
  }
  if (!isStunted(branch)) return;
  BranchStart nearby = startNearby(run, seed.points[0], parent);
  if (nearby.nodes.empty()) return;
  TrackedBranch other = trackFromStart(run, seed, parent, std::move(nearby), finished);
  if (other.nodes.size() > branch.nodes.size()) branch = std::move(other);
}

}  // namespace

TrackedBranch trackBranch(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent,
                          FinishedBranches finished) {
  TrackedBranch branch =
      trackFromStart(run, seed, parent, startAtSeed(run, seed, parent), finished);
  if (isStunted(branch)) trackStuntedAnew(run, seed, parent, finished, branch);
  if (branch.nodes.empty()) return branch;
  for (std::size_t i = 1; i < seed.points.size(); ++i) {
    const std::string missed = trackThroughClick(run, seed.points[i], branch, finished);
    if (missed.empty()) continue;
    branch.missedPoints.push_back("point " + std::to_string(i + 1) + ": there " + missed);
  }
  // the track may have been cut back to before its click
  branch.clickNode = std::min(branch.clickNode, branch.nodes.size() - 1);
  if (branch.nodes.size() < 2) {
    branch.nodes.clear();
    branch.failure =
        "a single cylinder fits at the seed, and nothing follows it; give a radius, a direction or "
        "a second point, or click where the vessel is longer";
  }
  return branch;
}

}  // namespace lumen::convert
