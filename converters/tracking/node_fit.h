// SPDX-License-Identifier: Apache-2.0
// One node: a cylinder through the wall around a guess, and the wall points that it explains
// (docs/method.md, sections 1.2 to 1.4).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/common/progress.h"
#include "converters/common/random.h"
#include "converters/tracking/cylinder.h"
#include "converters/tracking/rays.h"
#include "converters/tracking/track_options.h"
#include "converters/tracking/tracked_branch.h"

namespace lumen::convert {

/// What all tracks of one volume share. Only read: any number of threads may use one. What it
/// refers to must outlive it.
struct TrackContext {
  TrackContext(const BsplineVolume& theVolume, const TrackOptions& theOptions, double theNoiseFloor,
               const Progress& theProgress);

  const BsplineVolume& volume;
  const TrackOptions& options;
  double noiseFloor;  ///< see smoothing.h
  const Progress& progress;
  CylinderSearch search;
  std::vector<Eigen::Vector3d> rays;  ///< unit directions
};

/// Buffers of a track, of no meaning between calls. One per thread.
struct TrackWorkspace {
  explicit TrackWorkspace(const TrackContext& context);

  RayCaster caster;
  Candidates candidates;
  CylinderWorkspace cylinder;
  std::vector<std::size_t> inliers;
};

/// Where a node is looked for.
struct NodeGuess {
  Eigen::Vector3d centre, direction;  ///< mm, LPS; unit
  double radius = 0;                  ///< mm
  bool smooth = false;                ///< `direction` is that of a path: sharp turns are unlikely
  /// how far the centre may move along the axis, mm
  double slack = std::numeric_limits<double>::infinity();
};

struct NodeFit {
  std::optional<TrackedNode> node;  ///< empty if nothing at the guess is accepted
  double inlierRate = 0;            ///< of the best cylinder there, accepted or not
};

/// The least inlier rate of any node: half of the one that accepts a cylinder at once.
double leastInlierRate(const TrackOptions& options);

/// Fits a node of at least `minRate` to a guess. Empty if the guess or the fit lies outside of the
/// volume, or the fit cannot be told from noise.
NodeFit fitNode(const TrackContext& context, const NodeGuess& guess, double minRate, Random& random,
                TrackWorkspace& workspace);

}  // namespace lumen::convert
