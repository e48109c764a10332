// SPDX-License-Identifier: Apache-2.0
// Vessels along courses that are known over their whole length (docs/method.md, section 1.13).
#pragma once

#include <vector>

#include "converters/stages/tracking/corrections.h"
#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

/// Fits cylinders along the courses of a tree's seeds: their points, with radii, lead from the
/// parent's axis to the tip. A vessel along which too few cylinders fit is none: it gets no nodes,
/// and its children hang on the vessel before it. Where the context knows of places that are no vessels,
/// the volume must have edges at the walls of all others, too (wall_evidence.h). The result does not depend on the number of
/// threads. Throws Error(Cancelled).
void followCourses(const TrackContext& context, TrackedTree& tree, Progress& progress);

/// The stretches of courses outside of the known vessels of a tree. One that begins at the axis of
/// its parent, of which a stretch is left, keeps it; all others have none.
std::vector<SeedBranch> stretchesOutside(std::vector<SeedBranch> courses, const TrackedTree& tree);

/// Drops the vessels without children that have too few cylinders for the context's rules, once all
/// are joined.
void dropUnsupported(const TrackContext& context, TrackedTree& tree);

/// Searches at random for cylinders at the bridged nodes of the new vessels of a tree, outside of
/// all others, and corrects their walls. The ends of vessels stay. The result does not depend on the
/// number of threads. Throws Error(Cancelled).
void searchBridged(const TrackContext& context, const WallShape& shape, TrackedTree& tree);

}  // namespace lumen::convert
