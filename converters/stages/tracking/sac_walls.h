// SPDX-License-Identifier: Apache-2.0
// Walls of aneurysms and of their necks, once all vessels are tracked and joined (docs/method.md,
// section 1.7).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/tracking/sac_region.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Gives the nodes of every new aneurysm the whole wall of its sac, lobes included, up to the
/// vessels that open into it. Nodes of these vessels in the sac or at its neck, known ones
/// included, get the wall that is nearest to them, and lose points within the lumen, which would be
/// a wall across it. An aneurysm that is joined to another is one sac with it; known aneurysms
/// bound the new ones. Where no sac is found, nodes keep the points that rays found. Throws
/// Error(Cancelled).
void captureSacs(const TrackContext& context, TrackedTree& tree);

// Aneurysms are not tubes: their wall points come from the clicks alone (docs/method.md,
// section 1.7; Yureidini's thesis, 3.7).

/// A node around a click with the wall points that rays find, without direction and height; empty
/// if no ray meets a wall.
std::optional<TrackedNode> sacNodeAt(TrackRun& run, const SeedPoint& click);

/// Sets the directions and heights of a chain of at least two nodes to those of the step to the
/// next node; the last node repeats the one before.
void alignWithChain(std::vector<TrackedNode>& nodes);

/// Wall points of an aneurysm from its ordered centres, all of which have a radius. `parent`, which
/// may be null, is joined to the end of the chain that is nearer to it.
TrackedBranch captureAneurysm(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent);

// Centres of an aneurysm besides the clicked ones: for lobes, and for corners of its sac
// (docs/method.md, section 1.7).

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
