// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/follow.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "converters/stages/tracking/look_ahead.h"
#include "converters/stages/tracking/path_rules.h"

namespace lumen::convert {
namespace {

using formats::StopReason;

/// Radii before a face of the volume at which a track is at it: the rays see half of the wall, and
/// the centre stalls there.
constexpr double kFace = 1.5;
/// Radii from the goal's axis at which a way back has arrived: in its lumen, or at its wall.
constexpr double kArrived = 2.0;
/// Of the straight distance: a longer way back is one along other vessels.
constexpr double kLongestWay = 3.0;

bool isAtFace(const BsplineVolume& volume, const TrackedNode& last) {
  return !volume.geometry().containsWorld(last.centre + kFace * last.radius * last.direction);
}

/// What one step of a track did.
struct Step {
  std::optional<StopReason> stop;
  std::size_t changedFrom = 0;  ///< the first node that is new, if the track has grown
};

/// Appends the next node, or what follows it beyond a gap. `longest`: the length from which nodes
/// were given up last; only a track that has become longer may do so again, so that it ends.
Step stepOn(const TrackContext& context, std::vector<TrackedNode>& nodes, std::size_t& longest,
            Random& random, TrackWorkspace& workspace) {
  const TrackOptions& options = context.options;
  const std::size_t before = nodes.size();
  if (before >= static_cast<std::size_t>(options.maxNodes)) return {StopReason::StepLimit};
  const NodeGuess guess = predictNode(options, nodes.back(), 1, courseOf(nodes));
  if (!context.volume.geometry().containsWorld(guess.centre)) return {StopReason::LeftVolume};
  std::optional<TrackedNode> node =
      fitNode(context, guess, leastInlierRate(options), random, workspace).node;
  if (node && isSwollen(options, nodes, *node)) node.reset();
  const auto turn = node ? findTurningPoint(nodes, *node) : std::nullopt;
  if (node && !turn) {
    nodes.push_back(std::move(*node));
    return {{}, before};
  }
  if (turn) nodes.resize(std::max<std::size_t>(*turn, 1));
  const StopReason reason = node ? StopReason::TurnedBack : StopReason::NoValidCylinder;
  if (isAtFace(context.volume, nodes.back())) return {reason};
  // a path that turned back has given up nodes, and would turn back for ever if it might do so
  // again at the same place
  const bool isLonger = before > longest;
  if (turn && !isLonger) return {reason};
  Continuation next = findContinuation(context, nodes, isLonger, random, workspace);
  if (next.found.empty()) return {reason};
  if (next.kept < before) longest = before;
  nodes.resize(next.kept);
  std::move(next.found.begin(), next.found.end(), std::back_inserter(nodes));
  return {{}, std::min(before, nodes.size() - 1)};
}

}  // namespace

void followVessel(const TrackContext& context, TrackedBranch& branch,
                  std::span<const TrackedBranch* const> finished, Random& random,
                  TrackWorkspace& workspace) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  Step step;
  std::size_t longest = 0;
  while (!step.stop) {
    context.progress.check();
    step = stepOn(context, nodes, longest, random, workspace);
    for (std::size_t i = step.changedFrom; !step.stop && i < nodes.size(); ++i)
      if (inCore(finished, nodes[i])) {
        nodes.resize(i);
        step.stop = StopReason::MetBranch;
      }
  }
  branch.stopReason = isAtFace(context.volume, nodes.back()) ? StopReason::LeftVolume : *step.stop;
  if (branch.stopReason == StopReason::NoValidCylinder) dropTip(nodes);
}

std::vector<TrackedNode> trackBack(const TrackContext& context, const TrackedNode& start,
                                   const TrackedBranch& goal, Random& random,
                                   TrackWorkspace& workspace) {
  TrackedBranch back;
  back.nodes.push_back(reversed(start));
  const TrackedBranch* const end = &goal;
  followVessel(context, back, {&end, 1}, random, workspace);
  double way = 0;
  for (std::size_t i = 1; i < back.nodes.size(); ++i)
    way += (back.nodes[i].centre - back.nodes[i - 1].centre).norm();
  const ChainPoint reached = closestOnChain(goal.nodes, back.nodes.back().centre);
  const bool arrived =
      back.stopReason == StopReason::MetBranch || reached.distance < kArrived * reached.radius;
  if (!arrived || way > kLongestWay * closestOnChain(goal.nodes, start.centre).distance)
    back.nodes.resize(1);
  reverseTrack(back.nodes);
  return std::move(back.nodes);
}

}  // namespace lumen::convert
