// SPDX-License-Identifier: Apache-2.0
// Exact orientation tests: on which side a point lies.
#pragma once

#include <Eigen/Core>

namespace lumen::convert {

/// The sign (-1, 0, 1) of det [a - d, b - d, c - d], exactly: 1 if a, b and c run counter-clockwise
/// seen from the side on which d is not. Coordinates are finite and, where they are not 0, between
/// 1e-50 and 1e50. The bound of the first try and the expansions of the second are those of
/// Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// 1997.
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// The sign of det [a - c, b - c], exactly: 1 if a, b and c run counter-clockwise.
int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace lumen::convert
