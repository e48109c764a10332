// SPDX-License-Identifier: Apache-2.0
// Where tracks have ended although the lumen goes on: hairpins, kinks, forks, and starts beside the
// vessel (docs/method.md, section 1.12).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/way.h"

namespace lumen::convert {

/// The lumen around nodes, with the blur of its rim.
void addBalls(std::span<const TrackedNode> nodes, const VolumeGeometry& geometry,
              std::vector<Ball>& balls);

/// Goes on from the tip of a track that found no cylinder, turned back, or met another vessel: along each way that the
/// lumen leads on by, the straightest first, until one holds nodes like those before; from there as
/// usual. `others`: where it must not go. Writes the stop reason, and to `goesOn` how far the lumen
/// can be seen to lead on beyond the tip. Every round makes the track longer, so that it ends.
/// Throws Error(Cancelled).
void goOnward(const TrackContext& context, TrackedBranch& branch, std::span<const Ball> others,
              std::span<const TrackedBranch* const> finished, Random& random,
              TrackWorkspace& workspace);

/// A place near a click at which nothing fits, and the direction of the lumen there (unit, away from
/// the click).
struct NearbyPlace {
  Eigen::Vector3d position, direction;
};

/// Places along the lumen around a click, all ways, the nearest first. `others`: as above.
std::vector<NearbyPlace> placesAround(const TrackContext& context, const Eigen::Vector3d& click,
                                      std::span<const Ball> others);

}  // namespace lumen::convert
