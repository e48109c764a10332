// SPDX-License-Identifier: Apache-2.0
// Centres of an aneurysm besides the clicked ones: for lobes, and for corners of its sac
// (docs/method.md, section 1.7).
#pragma once

#include <span>
#include <vector>

#include "converters/stages/tracking/sac_region.h"

namespace lumen::convert {

/// Balls within a region for the parts of its `wall` that are more than half a radius outside of
/// the greatest balls around the sac's `nodes`. Parts that only balls narrower than `least` mm
/// reach get none; balls with hardly a place that is nearer to them than to the nodes, by power,
/// are left out. mm, LPS. Throws Error(Cancelled).
std::vector<SacBall> furtherCentres(const TrackContext& context, const SacRegion& region,
                                    std::span<const Eigen::Vector3d> wall,
                                    std::span<const SacBall> nodes, double least);

/// True if the straight line between two places stays within the lumen of a region.
bool isStraightPathInside(const VolumeGeometry& geometry, const SacRegion& region,
                          const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace lumen::convert
