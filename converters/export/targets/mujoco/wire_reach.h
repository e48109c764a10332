// SPDX-License-Identifier: Apache-2.0
// The walls that an instrument can touch.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The triangles of a surface of which a corner belongs to a node that is no farther than `length`,
/// mm, from `node` along the tree and its links. All of them if the surface does not know its
/// nodes.
SurfaceMesh wallsInReach(SurfaceMesh mesh, const formats::CenterlineTree& tree, std::uint32_t node,
                         double length);

/// Length, m, of a straight wire that lies free behind its tip, at most `length`: none of it in a
/// box around a piece, where it would be in the solid, or nearer than `radius` to it. All in
/// metres; triangles look out of the solid.
double freeBehind(const std::vector<SurfaceMesh>& pieces, const Eigen::Vector3d& tip,
                  const Eigen::Vector3d& direction, double length, double radius);

}  // namespace lumen::convert
