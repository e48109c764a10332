// SPDX-License-Identifier: Apache-2.0
// First nodes of tracks: at a click, or beside a parent (docs/method.md, section 1.7).
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// A start whose wall is seen by more than this share of the rays is sure: it needs no larger trial.
constexpr double kSeenWallShare = 0.5;

/// The first nodes of a branch, away from its parent, or the reason for their absence.
struct BranchStart {
  std::vector<TrackedNode> nodes;
  int parentNode = -1;    ///< node of the parent to which the first of them is joined
  NodeFit best;           ///< the rejected fit that is nearest to success
  bool inParent = false;  ///< something fitted, but in the parent's lumen
};

/// Direction of a vessel at its first point (unit, LPS), if the seed gives one or a second point.
std::optional<Eigen::Vector3d> statedDirection(const SeedBranch& seed);

/// One node at a click. Without a radius, trial radii from about one voxel up; the first that is
/// accepted, else the best. `smooth`: `direction` is known, not a guess.
BranchStart startAtClick(TrackRun& run, const SeedPoint& click, const Eigen::Vector3d& direction,
                         bool smooth);

/// The first nodes of a child, and the node of its parent to which they are joined. A click near
/// the parent: beyond the parent's wall towards the click (Yureidini's thesis, 3.6), else at the
/// click itself. A click farther away: there, and from there back to the parent.
BranchStart startChild(TrackRun& run, const SeedBranch& seed, const TrackedBranch& parent);

/// One node along the lumen near a click at which nothing fits, in any direction: the first from
/// which a track goes on; none if there is none. Leaves out the lumen of `parent`, which may be
/// null.
BranchStart startNearby(TrackRun& run, const SeedPoint& click, const TrackedBranch* parent);

}  // namespace lumen::convert
