// SPDX-License-Identifier: Apache-2.0
// From tracks to one lumen: gaps within a branch are filled, and every child is led to its parent's
// axis (docs/method.md, section 1.12).
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Puts nodes between neighbouring ones that are farther apart than their cylinders reach: fitted
/// where the volume shows the vessel, else bridged. Throws Error(Cancelled).
void fillGaps(const TrackContext& context, TrackedBranch& branch, Random& random,
              TrackWorkspace& workspace);

/// A way through the lumen from the first node of a branch to another branch.
struct LumenWay {
  int branch = -1;     ///< position in the seeds' order
  double outside = 0;  ///< mm of it that are darker than the wall
};

/// Whether the lumen leads from the first node of a branch to one of `others`, by position in the seeds'
/// order, which have nodes: as near as a bridge may be long, and with no gap that is longer than the
/// branch is wide. Throws Error(Cancelled).
std::optional<LumenWay> wayToOther(const TrackContext& context, std::span<const TrackedBranch> all,
                                   std::span<const int> others, const TrackedBranch& branch);

/// Leads a branch back from its first node to the axis of its parent, by nodes before that one, and
/// sets the parent's node that they hang on. A branch far from its parent with no lumen between them
/// becomes a root, and `unjoined` says so. `others`: branches of the parent's tree; if the way
/// through the lumen leads to one of these first, that is what the branch hangs on. All by position
/// in the seeds' order; those that have no nodes are passed over. Throws Error(Cancelled).
void joinToParent(const TrackContext& context, std::span<const TrackedBranch> all,
                  std::span<const int> others, TrackedBranch& branch, Random& random,
                  TrackWorkspace& workspace);

}  // namespace lumen::convert
