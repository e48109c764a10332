// SPDX-License-Identifier: Apache-2.0
// Vessels along courses that are known over their whole length (docs/method.md, section 1.13).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/corrections.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/tracking/track_run.h"

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

// Nodes along a line that is known to lead through a vessel (docs/method.md, section 1.12).

/// Nodes along a polyline (mm, LPS) strictly between its ends, half a radius apart. They are fitted
/// where the volume shows a wall of about the expected radius, which goes from `first` to `last`
/// mm; elsewhere, and inside of the lumen of `parent` (which may be null), they are bridged. Throws
/// Error(Cancelled).
std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Eigen::Vector3d> line,
                                    double first, double last, const TrackedBranch* parent);

/// Nodes along a course (mm, LPS) whose expected radius is known at each of its points, mm, strictly
/// between its ends, half a radius apart and fitted where the volume shows a wall. Nodes that are
/// refused are tried again with the radius of the nodes around them, and then along the curve between
/// those that fit, on which they stay if they are bridged.
std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Eigen::Vector3d> line,
                                    std::span<const double> radii);

/// The node that fits at a bridged one, of about its radius and course and between its neighbours;
/// empty if there is none.
std::optional<TrackedNode> nodeBetween(TrackRun& run, const TrackedNode& before,
                                       const TrackedNode& bridged, const TrackedNode& after);

// Whether the volume has edges where vessels that were found have their walls (docs/method.md,
// section 1.13).

/// Leaves of each new vessel the first stretch along which the volume has its wall, and nothing of
/// one that has none: bone, metal and texture let cylinders fit, but their edges lie at random.
/// Returns the further stretches of each branch, by its place. The result does not depend on the
/// number of threads. Throws Error(Cancelled).
std::vector<std::vector<TrackedBranch>> takeWithoutEdges(const TrackContext& context,
                                                         TrackedTree& tree);

}  // namespace lumen::convert
