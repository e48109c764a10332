// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/branch_tracker.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "converters/stages/tracking/branch_start.h"
#include "converters/stages/tracking/follow.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Times a parent's radius: a branch that starts farther from its axis may look the wrong way.
constexpr double kBeside = 2.5;
/// Of the distance between its first node and its parent: a tip nearer to that is its start.
constexpr double kWrongEnd = 0.5;

BranchStart startAtSeed(const TrackContext& context, const SeedBranch& seed,
                        const TrackedBranch* parent, Random& random, TrackWorkspace& workspace) {
  if (parent) return startChild(context, seed, *parent, random, workspace);
  const auto direction = directionOf(seed);
  return startAtClick(context, seed.points[0], direction.value_or(Vector3d::UnitZ()),
                      direction.has_value(), random, workspace);
}

/// Why a branch cannot go on from its start; empty if it can.
std::string failureOf(const TrackContext& context, const BranchStart& start,
                      std::span<const TrackedBranch* const> finished) {
  if (start.nodes.empty())
    return start.inParent ? "what fits at the seed lies in its parent's lumen; click farther along "
                            "the branch, and give its radius if it is thin"
                          : "at the seed " + failureText(context, start.best);
  if (inCore(finished, start.nodes.back())) return kTrackedAlready;
  return {};
}

/// A further click on the same vessel that the track may have missed: tracks from there back to the
/// track, gives up what the track has beyond the place of meeting, and goes on from the click. Says
/// why if nothing fits there; else empty.
std::string passThrough(const TrackContext& context, const SeedPoint& click, TrackedBranch& branch,
                        std::span<const TrackedBranch* const> finished, Random& random,
                        TrackWorkspace& workspace) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  const ChainPoint closest = closestOnChain(nodes, click.position);
  if (closest.distance <= closest.radius) return {};
  const Vector3d away = (click.position - closest.position) / closest.distance;
  const BranchStart start = startAtClick(context, click, away, false, random, workspace);
  if (start.nodes.empty()) return failureText(context, start.best);
  std::vector<TrackedNode> way = trackBack(context, start.nodes[0], branch, random, workspace);
  nodes.resize(closestOnChain(nodes, way.front().centre).node + 1);
  std::move(way.begin(), way.end(), std::back_inserter(nodes));
  followVessel(context, branch, finished, random, workspace);
  return {};
}

/// Tracks a root the other way first, so that its click is between its ends.
void followBack(const TrackContext& context, TrackedBranch& branch,
                std::span<const TrackedBranch* const> finished, Random& random,
                TrackWorkspace& workspace) {
  turnRound(branch);
  followVessel(context, branch, finished, random, workspace);
  turnRound(branch);
}

/// Radii from its click within which a track has died where it began.
constexpr double kStunted = 4;

/// True if a branch that began away from its parent has run towards it.
bool looksBack(const TrackedBranch& parent, const TrackedBranch& branch) {
  const ChainPoint first = closestOnChain(parent.nodes, branch.nodes.front().centre);
  const ChainPoint last = closestOnChain(parent.nodes, branch.nodes.back().centre);
  return first.distance > kBeside * first.radius && last.distance < kWrongEnd * first.distance;
}

/// The track from one start, both ways where it has no parent.
TrackedBranch trackFrom(const TrackContext& context, const SeedBranch& seed,
                        const TrackedBranch* parent, BranchStart start,
                        std::span<const TrackedBranch* const> finished, Random& random,
                        TrackWorkspace& workspace) {
  TrackedBranch branch;
  branch.parentNode = start.parentNode;
  branch.failure = failureOf(context, start, finished);
  if (!branch.failure.empty()) return branch;
  branch.nodes = std::move(start.nodes);
  branch.clickNode = branch.nodes.size() - 1;
  if (!parent && !seed.direction) followBack(context, branch, finished, random, workspace);
  followVessel(context, branch, finished, random, workspace);
  if (parent && looksBack(*parent, branch)) {
    turnRound(branch);
    followVessel(context, branch, finished, random, workspace);
  }
  return branch;
}

/// True for a track that died where it began.
bool isStunted(const TrackedBranch& branch) {
  if (branch.nodes.empty()) return true;
  const TrackedNode& click = branch.nodes[std::min(branch.clickNode, branch.nodes.size() - 1)];
  return std::all_of(branch.nodes.begin(), branch.nodes.end(), [&](const TrackedNode& node) {
    return (node.centre - click.centre).norm() < kStunted * click.radius;
  });
}

}  // namespace

TrackedBranch trackBranch(const TrackContext& context, const SeedBranch& seed,
                          const TrackedBranch* parent,
                          std::span<const TrackedBranch* const> finished, Random random) {
  TrackWorkspace workspace(context);
  TrackedBranch branch =
      trackFrom(context, seed, parent, startAtSeed(context, seed, parent, random, workspace),
                finished, random, workspace);
  if (isStunted(branch) && !branch.nodes.empty()) {
    TrackedBranch other = branch;
    turnRound(other);
    followVessel(context, other, finished, random, workspace);
    if (other.nodes.size() > branch.nodes.size()) branch = std::move(other);
  }
  if (isStunted(branch)) {
    BranchStart nearby = startNearby(context, seed.points[0], parent, random, workspace);
    if (!nearby.nodes.empty()) {
      TrackedBranch other =
          trackFrom(context, seed, parent, std::move(nearby), finished, random, workspace);
      if (other.nodes.size() > branch.nodes.size()) branch = std::move(other);
    }
  }
  if (branch.nodes.empty()) return branch;
  for (std::size_t i = 1; i < seed.points.size(); ++i) {
    const std::string missed =
        passThrough(context, seed.points[i], branch, finished, random, workspace);
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
