// SPDX-License-Identifier: Apache-2.0
// Projection of a point near the wall onto the surface of the case.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "formats/field/blended_field.h"

namespace lumen {

/// A point of the surface f = T of the blended field.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< gradient of f there, into the lumen
  std::uint32_t node = 0;                              ///< node at which following the point ends
};

/// The point of the surface that Newton's method on the level transform h (docs/method.md, section
/// 4) reaches from `start`, mm, with a cursor that begins at `node` and follows. `radius`, mm, is
/// the scale of the vessel: the estimated remaining distance is below 1e-4 of it. With `plane`, a
/// unit vector, the point stays in the plane through `start` normal to it. Empty if f or its slope
/// vanishes on the path, or if forty steps do not suffice.
std::optional<SurfacePoint> projectOnSurface(const field::BlendedField& surface,
                                             const Eigen::Vector3d& start, std::uint32_t node,
                                             double radius, const Eigen::Vector3d* plane = nullptr);

}  // namespace lumen
