// SPDX-License-Identifier: Apache-2.0
// One node: a cylinder through the wall around a guess, and the wall points that it explains
// (docs/method.md, sections 1.2 to 1.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Place and size of the search for a node.
struct NodeGuess {
  Eigen::Vector3d centre, direction;  ///< mm, LPS; unit
  double radius = 0;                  ///< mm
  bool smooth = false;                ///< `direction` is that of a path: sharp turns are unlikely
  /// length that the centre may move along the axis, mm
  double slack = std::numeric_limits<double>::infinity();
};

/// The stage that the search for a node reached; each value is nearer to success than those before.
enum class FitStage : std::uint8_t {
  OutsideVolume,  ///< the guess lies outside of the volume, or where no vessel is
  FewWalls,       ///< fewer than kFewestCandidates rays met a wall, or one wall
  LowRate,        ///< the best cylinder has too few inliers
  DarkInside,     ///< a cylinder fits, but much of its inside is no lumen
  LeftVolume,     ///< a cylinder fits, but its centre lies outside of the volume
  Noise,          ///< a cylinder fits, but not well, and its wall is as weak as noise
  Found
};

struct NodeFit {
  std::optional<TrackedNode> node;  ///< empty if nothing at the guess is accepted
  FitStage stage = FitStage::OutsideVolume;
  double inlierRate = 0;  ///< rate of the cylinder that decided
  double strength = 0;    ///< strength of its wall, for Noise
  std::size_t walls = 0;  ///< rays that met its wall, for FewWalls
  double dark = 0;        ///< dark share of its inside, for DarkInside
};

/// True if `a` came nearer to success than `b`.
bool isNearer(const NodeFit& a, const NodeFit& b);

/// The reason why nothing was accepted, with the numbers that decided and advice; continues a
/// sentence after "at the seed ".
std::string failureText(const TrackContext& context, const NodeFit& best);

/// The least inlier rate of any node: half of the one that accepts a cylinder at once.
double leastInlierRate(const TrackOptions& options);

/// Fits a node of at least `minRate` to a guess; where its wall is not supported by the volume (see
/// wall_support.h), to the lumen that it holds instead. Empty if the guess or the fit lies outside
/// of the volume or where the context knows of no vessel, if the fit cannot be distinguished from noise, or if no supported one is found.
NodeFit fitNode(TrackRun& run, const NodeGuess& guess, double minRate);

}  // namespace lumen::convert
