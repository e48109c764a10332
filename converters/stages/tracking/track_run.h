// SPDX-License-Identifier: Apache-2.0
// Data and buffers that the steps of tracking hand on to one another.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/base/random.h"
#include "converters/geometry/icosphere.h"
#include "converters/stages/tracking/cylinders/cylinder.h"
#include "converters/stages/tracking/cylinders/rays.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

/// Whether a place, mm, LPS, is known to be no vessel. An empty one knows of none.
struct PlaceTest {
  std::function<bool(const Eigen::Vector3d&)> test;
  /// Levels of tissue have shown it, so that courses hold none of it, and an edge beside what is
  /// brighter says nothing.
  bool isByLevel = false;
  /// Whether a place lies on the rim of what is no vessel, where a track is none; empty: not known.
  std::function<bool(const Eigen::Vector3d&)> isRim = {};

  explicit operator bool() const { return static_cast<bool>(test); }
  bool operator()(const Eigen::Vector3d& place) const { return test(place); }
};

/// The evidence that a vessel along a course needs.
struct CourseRules {
  double leastFitted = 1.0 / 3;  ///< share of its nodes that are cylinders
  bool isSurrounded = false;     ///< a cylinder has wall on all sides of its axis
  double apart = 0;              ///< radii between its axis and the wall of a known vessel
};

/// Meaning of a seed's points.
enum class SeedPoints : std::uint8_t {
  Clicks,  ///< places in a vessel, from which a track advances by random search
  Courses  ///< points with radii along the whole vessel: cylinders lie next to them
};

/// Data that all tracks of one volume share. Any number of threads may read one. The referenced
/// objects must outlive it.
struct TrackContext {
  TrackContext(const BsplineVolume& theVolume, const TrackOptions& theOptions, double theNoiseFloor,
               const Progress& theProgress, PlaceTest theNoVessel = {})
      : volume(theVolume),
        options(theOptions),
        noiseFloor(theNoiseFloor),
        progress(theProgress),
        isNoVessel(std::move(theNoVessel)),
        search(theOptions),
        rays(icosphere(icosphereOrder(theOptions.rays))) {}

  const BsplineVolume& volume;
  const TrackOptions& options;
  double noiseFloor;  ///< see smoothing.h
  const Progress& progress;
  PlaceTest isNoVessel;
  CourseRules rules;
  SeedPoints points = SeedPoints::Clicks;
  CylinderSearch search;
  std::vector<Eigen::Vector3d> rays;  ///< unit directions
};

/// Samples on a ray for each finest edge of a voxel where the course is known: a cubic spline hardly
/// differs from a parabola over four of them. Tracks from clicks take all that they may have.
constexpr double kSamplesPerEdge = 16.0;

/// Buffers of a track. One per thread; no call reads what another has left in them.
struct TrackWorkspace {
  explicit TrackWorkspace(const TrackContext& context)
      : caster(context.volume, context.rays, context.options.samples, context.options.dark,
               context.points == SeedPoints::Courses ? kSamplesPerEdge
                                                     : std::numeric_limits<double>::infinity()) {}

  RayCaster caster;
  Candidates candidates;
  CylinderWorkspace cylinder;
  std::vector<std::size_t> inliers;
};

/// One track at work: its volume, its stream of random numbers and its buffers. One per thread.
struct TrackRun {
  TrackRun(const TrackContext& theContext, Random theRandom)
      : context(theContext), random(theRandom), workspace(theContext) {}

  const TrackContext& context;
  Random random;
  TrackWorkspace workspace;
};

/// Branches that end a track when it runs into them.
using FinishedBranches = std::span<const TrackedBranch* const>;

}  // namespace lumen::convert
