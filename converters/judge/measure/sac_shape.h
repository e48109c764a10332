// SPDX-License-Identifier: Apache-2.0
// The neck and the dome of a sac in a field.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "converters/judge/measure/dome.h"
#include "converters/judge/measure/local_surface.h"
#include "converters/judge/measure/neck_plane.h"

namespace lumen::convert {

struct SacShape {
  NeckPlane neck;
  DomeSurface dome;
  DomeShape shape;  ///< for triangles of no size
  DomeShape moved;  ///< if the neck were `shift` farther out
};

/// Nothing if no plane separates the sac. `radius`: of a ball in the sac, whose centre is `seed`, mm;
/// triangles are a twentieth of it. `shift`: mm.
std::optional<SacShape> findSacShape(const BoxedField& field, const NeckPlace& place,
                                     const Eigen::Vector3d& seed, double radius, double shift,
                                     const Progress& progress);

}  // namespace lumen::convert
