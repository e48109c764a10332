// SPDX-License-Identifier: Apache-2.0
// Conversion of tracks to one lumen: gaps within a branch are filled, and every child is led to its
// parent's axis (docs/method.md, section 1.12).
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Inserts nodes between neighbours that are farther apart than their cylinders reach: fitted where
/// the volume shows the vessel, else bridged. Throws Error(Cancelled).
void fillGaps(TrackRun& run, TrackedBranch& branch);

/// A path through the lumen from the first node of a branch to another branch.
struct PathToBranch {
  int branch = -1;     ///< position in the seeds' order
  double outside = 0;  ///< part of its length that is darker than the wall, mm
};

/// The path through the lumen from the first node of a branch to one of `others`, which have nodes,
/// by position in the seeds' order. Empty if none of them is within the length of a bridge, or if
/// every path has a gap longer than the branch is wide. Throws Error(Cancelled).
std::optional<PathToBranch> pathToOther(const TrackContext& context,
                                        std::span<const TrackedBranch> all,
                                        std::span<const int> others, const TrackedBranch& branch);

/// Leads a branch back from its first node to the axis of its parent, by nodes before that one, and
/// sets the parent's node to which they are joined. A branch far from its parent with no lumen
/// between them becomes a root, and `unjoined` gives the reason. `others`: branches of the parent's
/// tree; if the path through the lumen leads to one of these first, the branch is joined to that
/// one. All by position in the seeds' order; branches without nodes are ignored. Throws
/// Error(Cancelled).
void joinToParent(TrackRun& run, std::span<const TrackedBranch> all, std::span<const int> others,
                  TrackedBranch& branch);

}  // namespace lumen::convert
