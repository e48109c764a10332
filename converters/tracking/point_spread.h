// SPDX-License-Identifier: Apache-2.0
// How a volume's blur displaces the walls that its gradient shows, and how wide that blur is
// (docs/method.md, section 1.9).
#pragma once

#include <optional>
#include <span>

#include "converters/tracking/tracked_branch.h"
#include "converters/volume/bspline.h"

namespace lumen::convert {

/// The radius of the cylinder that, under an isotropic Gaussian blur of standard deviation `sigma`,
/// has its steepest fall at the distance `seen` from its axis (all in one unit). The blurred disc
/// of radius R falls by (R/s^2) exp(-(r^2 + R^2)/(2 s^2)) I1(r R/s^2), which is steepest where z
/// I0(z)/I1(z) = (r/s)^2 + 1 with z = r R/s^2: about s^2/(2R) inside of the wall, and never nearer
/// to the axis than s. There the radius cannot be told; the least that is returned is seen / 2.
double cylinderRadius(double seen, double sigma);

/// The same for the ball, whose wall is bent both ways: its steepest fall is about s^2/R inside.
double ballRadius(double seen, double sigma);

/// Standard deviation, mm, of the Gaussian whose blur makes the walls of the tracked vessels as
/// wide as they are: from the width at half height of the derivative of the mean profile across
/// each of the widest nodes, the median over them. It holds the voxel's own box and the spline as
/// well as the scanner. Empty where fewer than eight nodes are wide enough to show it.
std::optional<double> measurePointSpread(const BsplineVolume& volume,
                                         std::span<const TrackedBranch* const> vessels, bool dark);

/// Moves radii and wall points outward by what a blur of `sigma` mm has displaced them: away from
/// the node's axis in a vessel, from its centre in an aneurysm.
void correctWalls(TrackedBranch& branch, formats::BranchKind kind, double sigma);

}  // namespace lumen::convert
