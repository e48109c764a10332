// SPDX-License-Identifier: Apache-2.0
// Steps along the wall towards the point that is nearest to a query point.
#pragma once

#include "formats/field/vector.h"

namespace lumen::blob {

/// The wall at a foot: the vector from there to the query point, the outward normal, the signed
/// distance of the query point along it, and derivatives of f times one positive factor.
struct WallShape {
  field::Vec toQuery, normal;
  double distance;  ///< mm
  double slope;     ///< |grad f|
  double hessian[6];
};

/// Lengths that bound a step, mm.
struct StepBounds {
  double radius, tolerance;
};

/// Solves (I + d S) step = tangential part of the vector to the query point, S the shape operator
/// of the wall and d the distance. Directions in which the foot is a farthest point are followed
/// downhill. mm; at most half the radius.
field::Vec stepDownhill(const WallShape& wall, const StepBounds& bounds) noexcept;

}  // namespace lumen::blob
