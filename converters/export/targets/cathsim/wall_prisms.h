// SPDX-License-Identifier: Apache-2.0
// A wall as convex pieces that leave the lumen open.
#pragma once

#include <functional>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// Whether a point, in the mesh's frame, is in a lumen.
using InLumen = std::function<bool(const Float3& point)>;

/// A prism outwards from each triangle of the mesh's walls; ends are left open. Its height is
/// `share` of the radius at each corner, along the corner's normal, which neighbours share, so
/// there is no gap between them; it is halved, up to six times, while its upper end or its middle
/// is in a lumen. A triangle of a wall that is hollow towards the lumen lies in the lumen by no
/// more than the mesh is off the surface. Prisms of less than `leastVolume`, in the mesh's unit,
/// are left out.
std::vector<SurfaceMesh> wallPrisms(const SurfaceMesh& mesh, double share, double leastVolume,
                                    const InLumen& inLumen);

}  // namespace lumen::convert
