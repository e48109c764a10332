// SPDX-License-Identifier: Apache-2.0
// Review of the walls of a tracked vessel, with both neighbours of every node known
// (docs/method.md, section 1.11).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/tracking/track_run.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

/// Nodes that are much wider than the vessel on both sides of them, by a poor fit, are fitted anew
/// with the radius that the sides let expect; where nothing fits, they are marked as bridged and
/// lose their points. Then vessels that are not round get their walls (wall_section.h). All other
/// nodes, and known branches, stay as they are.
void reviewWalls(const TrackContext& context, TrackedTree& tree);

// The wall of vessels that are not round, or that taper (docs/method.md, section 1.11).

/// Gives the measured, poorly fitted nodes of a vessel walls that are ellipses about its course and
/// may taper along it: with the wall points that such a section explains, its middle, and the
/// radius of a disc of the same area. A node keeps its cylinder where the section explains hardly
/// more points, covers less of the way around than the cylinder does, or covers less than two
/// thirds of it.
void fitSections(TrackRun& run, std::vector<TrackedNode>& nodes);

// Whether the volume supports the wall that a node was given (docs/method.md, section 1.11).

/// The contents of a node's cylinder.
struct WallSupport {
  double dark = 0;  ///< share of the inside that is beyond the level of the node's wall, in [0, 1]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mm, LPS, of the lumen nearest to `guess`
  double radius = 0;                                 ///< mm, of a disc as large as all of its lumen
};

/// Samples the inside of a node, up to four fifths of its radius, and compares it with the median
/// intensity at its wall points. A wall around a vessel holds lumen only; a wall that takes in the
/// gap to a neighbour, or that bulges into the dark, does not. `dark`: vessels are darker than
/// their background. Without points all of the inside counts as lumen. `guess`: the expected place
/// of the vessel, mm, LPS; of several lumens inside, `middle` is that of the nearest.
WallSupport wallSupport(const BsplineVolume& volume, const TrackedNode& node,
                        const Eigen::Vector3d& guess, bool dark);

/// True if so little of the inside is dark that the node's wall is one vessel's.
bool isSupported(const WallSupport& support);

}  // namespace lumen::convert
