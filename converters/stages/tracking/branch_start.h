// SPDX-License-Identifier: Apache-2.0
// Where tracks begin: at a click, or beside a parent (docs/method.md, section 1.7).
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// The first nodes of a branch, away from its parent, and why there are none.
struct BranchStart {
  std::vector<TrackedNode> nodes;
  int parentNode = -1;    ///< that the first of them hangs on
  NodeFit best;           ///< of what was not accepted, the nearest to success
  bool inParent = false;  ///< something fitted, but in the parent's lumen
};

/// Steps that a start must lead on for; noise leads on for one or two.
constexpr int kTrialSteps = 4;
/// How many steps, up to kTrialSteps, a track from a node that was fitted to a guess goes on outside
/// of the lumen of `parent`, which may be null.
int stepsFrom(const TrackContext& context, const TrackedNode& start, const TrackedBranch* parent,
              Random& random, TrackWorkspace& workspace);

/// Where a vessel goes from its first point (unit, LPS), as far as the user said.
std::optional<Eigen::Vector3d> directionOf(const SeedBranch& seed);

/// One node at a click. Without a radius, trial radii from about one voxel up; the first that is
/// accepted, else the best. `smooth`: `direction` is known, not a guess.
BranchStart startAtClick(const TrackContext& context, const SeedPoint& click,
                         const Eigen::Vector3d& direction, bool smooth, Random& random,
                         TrackWorkspace& workspace);

/// The first nodes of a child, and where they hang on its parent. A click near the parent: beyond
/// the parent's wall on the way to the click (Yureidini's thesis, 3.6), else at the click
/// itself. A click farther away: there, and from there back to the parent.
BranchStart startChild(const TrackContext& context, const SeedBranch& seed,
                       const TrackedBranch& parent, Random& random, TrackWorkspace& workspace);

/// One node a little way along the lumen from a click at which nothing fits, either way: the first
/// that leads on; none if none does. `parent` may be null; its lumen is left out.
BranchStart startNearby(const TrackContext& context, const SeedPoint& click,
                        const TrackedBranch* parent, Random& random, TrackWorkspace& workspace);

}  // namespace lumen::convert
