// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/branch_start.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/path_rules.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using formats::StopReason;

/// Radii from the goal's axis at which a track back has arrived: in its lumen, or at its wall.
constexpr double kArrivedRadii = 2.0;

/// A track back that is longer than this many straight distances leads along other vessels.
constexpr double kLongestReturn = 3.0;

/// Least inlier rate beyond a gap, as a share of the recent mean. A find must be nearly as good a
/// cylinder as the vessel was; its contrast may fall by more.
constexpr double kLikeRate = 0.8;
/// Recent radii: a shorter gap is bridged in any direction of the vessel beyond it.
constexpr double kShortGapRadii = 2.0;
/// Cosine of 40 degrees, the largest angle between the bridge and a vessel beyond a gap; and of 50,
/// the largest turn. Another vessel that passes by runs across.
constexpr double kOnCourseCosine = 0.77, kLargestTurnCosine = 0.64;
/// Directions around the last one that are tried, and the tangent of their angle to it.
constexpr int kSides = 6;
constexpr double kTiltTangent = 0.5;
/// Nodes that are given up, by turns. A track goes astray for a node or a few.
constexpr std::array<std::size_t, 3> kGivenUpNodes = {0, 3, 6};

/// Limits on nodes beyond a gap, by the vessel so far.
struct Likeness {
  const TrackedNode& last;
  RecentMeans mean;

  [[nodiscard]] bool holds(const TrackedNode& node) const {
    return node.strength >= kLikeStrength * mean.strength &&
           node.radius >= kNarrowest * last.radius && node.radius <= kWidest * last.radius;
  }
  [[nodiscard]] bool onCourse(const TrackedNode& node) const {
    const Vector3d bridge = node.centre - last.centre;
    return bridge.norm() < kShortGapRadii * mean.radius ||
           (bridge.normalized().dot(node.direction) > kOnCourseCosine &&
            last.direction.dot(node.direction) > kLargestTurnCosine);
  }
};

/// The last direction, or one tilted from it to a side in 1 .. kSides.
Vector3d directionTo(int side, const Vector3d& straight) {
  if (side == 0) return straight;
  const auto [e1, e2] = planeBasis(straight);
  const double angle = std::numbers::pi / 3.0 * side;
  const Vector3d aside = std::cos(angle) * e1 + std::sin(angle) * e2;
  return Vector3d(straight + kTiltTangent * aside).normalized();
}

/// Two consecutive nodes from a guess on; empty if they are not this vessel's.
std::vector<TrackedNode> fitPair(TrackRun& run, std::span<const TrackedNode> nodes,
                                 const Likeness& like, const NodeGuess& guess) {
  const TrackOptions& options = run.context.options;
  const double minRate = std::max(leastInlierRate(options), kLikeRate * like.mean.inlierRate);
  std::optional<TrackedNode> first = fitNode(run, guess, minRate).node;
  if (!first || !like.holds(*first) || findTurningPoint(nodes, *first)) return {};
  const NodeGuess next = predictNode(options, *first, 1, first->direction);
  std::optional<TrackedNode> second = fitNode(run, next, minRate).node;
  if (!second || !like.holds(*second) || !like.onCourse(*second) ||
      findTurningPoint(std::array{like.last, *first}, *second))
    return {};
  return {std::move(*first), std::move(*second)};
}

/// The two nodes of the nearest place ahead of a track where it may continue; empty if there is
/// none.
std::vector<TrackedNode> findPairAhead(TrackRun& run, std::span<const TrackedNode> nodes) {
  const TrackContext& context = run.context;
  const Likeness like{nodes.back(), recentMeans(nodes)};
  for (int steps = 1; steps <= context.options.lookAhead; ++steps)
    for (int side = 0; side <= kSides; ++side) {
      context.progress.check();
      const Vector3d direction = directionTo(side, like.last.direction);
      const NodeGuess guess = predictNode(context.options, like.last, steps, direction);
      std::vector<TrackedNode> pair = fitPair(run, nodes, like, guess);
      if (!pair.empty()) return pair;
    }
  return {};
}

/// Nodes beyond a gap.
struct Continuation {
  std::size_t kept = 0;            ///< nodes of the track that stay
  std::vector<TrackedNode> found;  ///< the nodes after those; empty if there is no continuation
};

/// The nearest place ahead of a track's last node, where the next step finds nothing, at which two
/// consecutive nodes fit as well as the vessel did so far. If there is none and `mayGiveUp`, looks
/// ahead from nodes before, since the last ones may have gone astray.
Continuation findBeyondGap(TrackRun& run, std::span<const TrackedNode> nodes, bool mayGiveUp) {
  for (const std::size_t back : kGivenUpNodes) {
    if (back > 0 && (!mayGiveUp || nodes.size() < back + 2)) break;
    const std::size_t kept = nodes.size() - back;
    std::vector<TrackedNode> found = findPairAhead(run, nodes.first(kept));
    if (!found.empty()) return {kept, std::move(found)};
  }
  return {nodes.size(), {}};
}

/// The outcome of one step of a track.
struct Step {
  std::optional<StopReason> stop;
  std::size_t changedFrom = 0;  ///< the first node that is new, if the track has grown
};

/// Appends the next node, or the nodes beyond a gap. `longest`: the length from which nodes were
/// given up last; only a track that has become longer may do so again, so that it ends.
Step trackOneStep(TrackRun& run, std::vector<TrackedNode>& nodes, std::size_t& longest) {
  const TrackContext& context = run.context;
  const TrackOptions& options = context.options;
  const std::size_t before = nodes.size();
  if (before >= static_cast<std::size_t>(options.maxNodes)) return {StopReason::StepLimit};
  const NodeGuess guess = predictNode(options, nodes.back(), 1, trackDirection(nodes));
  if (!context.volume.geometry().containsWorld(guess.centre)) return {StopReason::LeftVolume};
  std::optional<TrackedNode> node = fitNode(run, guess, leastInlierRate(options)).node;
  if (node && isSwollen(options, nodes, *node)) node.reset();
  const auto turn = node ? findTurningPoint(nodes, *node) : std::nullopt;
  if (node && !turn) {
    nodes.push_back(std::move(*node));
    return {{}, before};
  }
  if (turn) nodes.resize(std::max<std::size_t>(*turn, 1));
  const StopReason reason = node ? StopReason::TurnedBack : StopReason::NoValidCylinder;
  if (isAtFace(context.volume.geometry(), nodes.back())) return {reason};
  // a track that turned back has given up nodes, and would turn back for ever if it might do so
  // again at the same place
  const bool isLonger = before > longest;
  if (turn && !isLonger) return {reason};
  Continuation next = findBeyondGap(run, nodes, isLonger);
  if (next.found.empty()) return {reason};
  if (next.kept < before) longest = before;
  nodes.resize(next.kept);
  std::move(next.found.begin(), next.found.end(), std::back_inserter(nodes));
  return {{}, std::min(before, nodes.size() - 1)};
}

}  // namespace

void trackToEnd(TrackRun& run, TrackedBranch& branch, FinishedBranches finished) {
  const TrackContext& context = run.context;
  std::vector<TrackedNode>& nodes = branch.nodes;
  Step step;
  std::size_t longest = 0;
  while (!step.stop) {
    context.progress.check();
    step = trackOneStep(run, nodes, longest);
    for (std::size_t i = step.changedFrom; !step.stop && i < nodes.size(); ++i)
      if (inCore(finished, nodes[i])) {
        nodes.resize(i);
        step.stop = StopReason::MetBranch;
      }
  }
  branch.stopReason =
      isAtFace(context.volume.geometry(), nodes.back()) ? StopReason::LeftVolume : *step.stop;
  if (branch.stopReason == StopReason::NoValidCylinder) dropTip(nodes);
}

std::vector<TrackedNode> trackBackTo(TrackRun& run, const TrackedNode& start,
                                     const TrackedBranch& goal) {
  TrackedBranch back;
  back.nodes.push_back(reversed(start));
  const TrackedBranch* const end = &goal;
  trackToEnd(run, back, {&end, 1});
  const ChainPoint reached = closestOnChain(goal.nodes, back.nodes.back().centre);
  const bool arrived =
      back.stopReason == StopReason::MetBranch || reached.distance < kArrivedRadii * reached.radius;
  const double straight = closestOnChain(goal.nodes, start.centre).distance;
  if (!arrived || measureLength(back.nodes) > kLongestReturn * straight) back.nodes.resize(1);
  reverseTrack(back.nodes);
  return std::move(back.nodes);
}

int trialSteps(TrackRun& run, const TrackedNode& start, const TrackedBranch* parent) {
  const FinishedBranches others(&parent, parent ? 1 : 0);
  const TrackOptions& options = run.context.options;
  std::vector<TrackedNode> nodes{start};
  for (int step = 0; step < kTrialSteps; ++step) {
    const NodeGuess guess = predictNode(options, nodes.back(), 1, nodes.back().direction);
    auto next = fitNode(run, guess, leastInlierRate(options)).node;
    if (!next || isSwollen(options, nodes, *next) || findTurningPoint(nodes, *next) ||
        inCore(others, *next))
      return step;
    nodes.push_back(std::move(*next));
  }
  return kTrialSteps;
}

namespace {

using Eigen::Vector3d;

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
