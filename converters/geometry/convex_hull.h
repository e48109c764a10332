// SPDX-License-Identifier: Apache-2.0
// The convex hull of points.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// The triangles of the convex hull of points, counter-clockwise seen from outside, as indices of
/// the points; none if all points lie in one plane. Exact: no point lies outside of it, as
/// orientation() of exact_predicates.h decides; points must be within its range. Points in the
/// plane of a face are corners only where a triangle needs them. C. B. Barber, D. P. Dobkin and
/// H. Huhdanpaa, The quickhull algorithm for convex hulls, 1996.
std::vector<Triangle> convexHull(std::span<const Eigen::Vector3d> points);

}  // namespace lumen::convert
