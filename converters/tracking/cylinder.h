// SPDX-License-Identifier: Apache-2.0
// A cylinder through wall candidates: RANSAC with a pruned direction search (thesis section 3.4).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/common/random.h"
#include "converters/tracking/rays.h"
#include "converters/tracking/track_options.h"

namespace lumen::convert {

/// An infinite circular cylinder and the share of the candidates that lie in its band.
struct Cylinder {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< a point on the axis, mm, LPS
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit
  double radius = 0;                                 ///< mm
  double inlierRate = 0;                             ///< in [0, 1]
};

/// Estimates cylinders; keeps its buffers between calls. Not thread-safe: one per thread.
class CylinderEstimator {
public:
  explicit CylinderEstimator(const TrackOptions& options);

  /// The best cylinder through `points` that holds their origin, with an axis within 90 degrees of
  /// `direction` and a radius in [rho/2, 3 rho/2]: the first axis, by increasing angle, whose rate
  /// reaches the accepting one; else the best of all, where `smooth` says that a rate at an angle a
  /// from `direction` counts (1 + cos a)/2 of itself (its rate may be anything; 0 and no radius if
  /// none is valid). Refined to least squares on its inliers.
  Cylinder estimate(const Candidates& points, const Eigen::Vector3d& direction, double rho,
                    bool smooth, Random& random);

  /// Least squares of (distance to the axis - radius) over the inliers, over the axis' position,
  /// direction and radius, inliers chosen anew between rounds; then the centre moves along the axis
  /// to the median of the inliers. Returns the start if that has no more inliers.
  Cylinder refine(const Candidates& points, const Cylinder& start);

  /// Indices of the candidates whose distance to the axis is within the band around the radius.
  void inliers(const Candidates& points, const Cylinder& cylinder,
               std::vector<std::size_t>& out) const;

private:
  struct Circle {
    float u = 0, v = 0, radius = 0;
    int inliers = 0;
  };
  Circle bestCircle(double rho, double needed, Random& random);
  void project(const Candidates& points, const Eigen::Vector3d& e1, const Eigen::Vector3d& e2);

  TrackOptions m_options;
  std::vector<Eigen::Vector3d> m_sphere;
  std::vector<float> m_u, m_v;
  std::vector<std::size_t> m_inliers;
  std::vector<double> m_along;
};

/// Two unit vectors that span the plane normal to the unit vector `axis`.
std::pair<Eigen::Vector3d, Eigen::Vector3d> planeBasis(const Eigen::Vector3d& axis);

}  // namespace lumen::convert
