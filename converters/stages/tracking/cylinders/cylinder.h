// SPDX-License-Identifier: Apache-2.0
// A cylinder through wall candidates: RANSAC with a pruned direction search (docs/method.md,
// sections 1.3 and 1.4; Yureidini's thesis, 3.4).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "converters/base/random.h"
#include "converters/stages/tracking/cylinders/rays.h"
#include "converters/stages/tracking/cylinders/track_options.h"

namespace lumen::convert {

// Circles through three points, many at a time: the hot loops of the search for a cylinder.

constexpr std::size_t kCircleBlock = 32;

/// Circles as a structure of arrays. All in mm, in a plane whose origin is that of the rays.
struct CircleBlock {
  using Lanes = std::array<float, kCircleBlock>;
  alignas(64) Lanes u, v;            ///< first point of the triple, then the centre
  alignas(64) Lanes au, av, bu, bv;  ///< second and third point, relative to the first
  alignas(64) Lanes squaredRadius;   ///< mm^2; 0 where the circle is not valid
};

/// Triples of the points (u, v), with repetition.
void drawTriples(const std::vector<float>& u, const std::vector<float>& v, Random& random,
                 CircleBlock& block);

/// Turns triples into circles (Yureidini's thesis, eq. 3.1). Valid are those with a radius in
/// [low, high] that hold the origin.
void circlesThrough(CircleBlock& block, float low, float high);

/// Points within `band` of the circle, by squared distances: low2 <= |p - centre|^2 <= high2.
int countInBand(const float* u, const float* v, std::size_t count, float centreU, float centreV,
                float low2, float high2);
/// Points within the band of a circle, one at a time: the reference for countInBand.
int countInBandReference(const float* u, const float* v, std::size_t count, float centreU,
                         float centreV, float low2, float high2);

/// Fewer candidates or inliers than this decide about no cylinder: it has five unknowns.
constexpr std::size_t kFewestCandidates = 8;

/// Width of one vessel from one place to the next, in radii there. Narrowing is usual, growing is not.
constexpr double kNarrowest = 0.6, kWidest = 1.5;

/// An infinite circular cylinder and the share of the candidates that lie in its band.
struct Cylinder {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< a point on the axis, mm, LPS
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit
  double radius = 0;                                 ///< mm
  double inlierRate = 0;                             ///< in [0, 1]
};

/// Parameters of the search for cylinders. Only read: any number of threads may share one.
struct CylinderSearch {
  explicit CylinderSearch(const TrackOptions& options);

  double acceptedRate;  ///< p_inl
  double band;          ///< r_t, relative to the radius
  int minTrials, maxTrials;
  std::vector<Eigen::Vector3d> sphere;  ///< an icosphere; half of it are the axes
};

/// The expected direction and radius of a cylinder.
struct ExpectedCylinder {
  Eigen::Vector3d direction;  ///< unit
  double radius = 0;          ///< rho, mm
  bool smooth = false;        ///< `direction` is that of a path: sharp turns are unlikely
};

/// Buffers of the search, of no meaning between calls. One per thread.
struct CylinderWorkspace {
  std::vector<float> u, v;  ///< candidates in the plane normal to an axis
  std::vector<std::size_t> inliers;
  std::vector<double> along;
};

/// The best cylinder through `points` that holds their origin, with an axis within 90 degrees of
/// the expected direction and a radius in [rho/2, 3 rho/2]: the first axis, by increasing angle,
/// whose rate reaches the accepted one; else the best of all. With `smooth` a rate at an angle a
/// from the direction is weighted by (1 + cos a)/2. The rate of the result may be anything; it is
/// 0, without a radius, if no cylinder is valid. Refined to least squares on its inliers.
Cylinder estimateCylinder(const CylinderSearch& search, const Candidates& points,
                          const ExpectedCylinder& expected, Random& random,
                          CylinderWorkspace& workspace);

/// 1 for equal radii, less the more they differ: a vessel changes its width slowly. 0 for none.
inline double radiusLikeness(double radius, double expected) {
  return radius > 0 ? std::sqrt(std::min(radius / expected, expected / radius)) : 0.0;
}

/// Least squares of (distance to the axis - radius) over the inliers, over the axis' position,
/// direction and radius, inliers chosen anew between rounds; then the centre moves along the axis
/// to the median of the inliers. Returns the start if that has no more inliers.
Cylinder refineCylinder(const Candidates& points, const Cylinder& start, double band,
                        CylinderWorkspace& workspace);

/// Indices of the candidates whose distance to the axis is within `band` radii of the radius.
void findInliers(const Candidates& points, const Cylinder& cylinder, double band,
                 std::vector<std::size_t>& out);

}  // namespace lumen::convert
