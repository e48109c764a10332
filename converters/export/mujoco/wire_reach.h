// SPDX-License-Identifier: Apache-2.0
// The walls that an instrument can touch.
#pragma once

#include <cstdint>

#include "converters/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The triangles of a surface of which a corner belongs to a node that is no farther than `length`, mm, from `node`
/// along the tree and its links. All of them if the surface does not know its nodes.
SurfaceMesh wallsInReach(SurfaceMesh mesh, const formats::CenterlineTree& tree, std::uint32_t node,
                         double length);

}  // namespace lumen::convert
