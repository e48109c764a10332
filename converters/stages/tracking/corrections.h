// SPDX-License-Identifier: Apache-2.0
// Corrections of tracked vessels: of walls, which a volume's blur displaces, and of centres in
// bends (docs/method.md, sections 1.9 and 1.10).
#pragma once

#include <optional>
#include <span>

#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

/// The radius of the cylinder that, under an isotropic Gaussian blur of standard deviation `sigma`,
/// has its steepest fall at the distance `seen` from its axis (all in one unit). The blurred disc
/// of radius R falls by (R/s^2) exp(-(r^2 + R^2)/(2 s^2)) I1(r R/s^2), which is steepest where z
/// I0(z)/I1(z) = (r/s)^2 + 1 with z = r R/s^2: about s^2/(2R) inside of the wall, and never nearer
/// to the axis than s. Nearer falls do not determine the radius; the least that is returned is seen
/// / 2.
double cylinderRadius(double seen, double sigma);

/// The radius of the ball that has its steepest fall at the distance `seen` from its centre. Its
/// wall is bent in both directions, so that the fall is about s^2/R inside.
double ballRadius(double seen, double sigma);

/// The mean shape of the walls of tracked vessels.
struct WallShape {
  /// mm, standard deviation of the Gaussian whose blur makes the walls as wide as they are: from
  /// the width at half height of the derivative of the profile. It holds the voxel's own box and
  /// the spline as well as the scanner.
  double pointSpread = 0;
  /// mm, outward of the steepest fall: the place where the intensity is halfway between lumen and
  /// background, less the displacement by the blur of a round wall. 0 for an even lumen; less than
  /// 0 where it darkens towards its wall.
  double halfLevel = 0;
};

/// The shape of the walls of vessels, as medians over the widest nodes, each from the mean profile
/// across its wall. Empty where fewer than eight nodes are wide enough to show it.
std::optional<WallShape> measureWalls(const BsplineVolume& volume,
                                      std::span<const TrackedBranch* const> vessels, bool dark);

/// Moves radii and wall points from the steepest fall to the wall: to the half level, by at most a
/// tenth of the radius, and outward by the displacement of the blur; away from the node's axis in
/// a vessel, from its centre in an aneurysm.
void correctWalls(TrackedBranch& branch, formats::BranchKind kind, const WallShape& shape);

/// Moves centres back onto the axis of a bent vessel. A straight cylinder through the wall of a
/// vessel of curvature k lies by k <w^2> / 2 to the inner side of the bend, where <w^2> is the mean
/// square of its wall points' places along its axis. The curvature is that of the circle through
/// the node and the nearest ones on either side that are at least its height away; nodes without
/// such neighbours stay, and none moves by more than a tenth of its radius.
void correctBends(std::vector<TrackedNode>& nodes);

}  // namespace lumen::convert
