// SPDX-License-Identifier: Apache-2.0
// Directions that cover the sphere evenly.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

/// Unit vertices of an icosahedron whose edges are halved `order` - 1 times: 10 * 4^(order - 1) + 2
/// of them (12, 42, 162, 642). The set is symmetric: vertex 2 i + 1 is the opposite of vertex 2 i.
std::vector<Eigen::Vector3d> icosphere(int order);

/// The order whose icosphere has `vertices` vertices; 0 if there is none among orders 1 to 4.
int icosphereOrder(int vertices);

/// Half of an icosphere of 2 * `count` vertices, turned so that its first entry is `direction`
/// (unit), by increasing angle to it; all within 90 degrees.
std::vector<Eigen::Vector3d> axesAround(const Eigen::Vector3d& direction,
                                        const std::vector<Eigen::Vector3d>& sphere);

}  // namespace lumen::convert
