// SPDX-License-Identifier: Apache-2.0
// The part of a closed surface on which layers of prisms stand.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A flat end, whose rim moves within its plane.
struct LayerRim {
  std::uint32_t group = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the rim's vertices, mm
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, out of the vessel
  std::vector<std::uint32_t> loop;  ///< vertices of the base, counter-clockwise seen from outside
};

/// The triangles of a surface but those of flat ends.
struct LayerBase {
  TriangleMesh mesh;
  std::vector<std::uint32_t> group;   ///< of each triangle
  std::vector<std::uint32_t> vertex;  ///< of the surface, for each of the base
  std::vector<std::uint32_t> rimOf;   ///< index into `rims` of each vertex, or kAbsent
  std::vector<LayerRim> rims;
};

/// Throws Error(Failed) unless each flat end has one rim, and no two rims meet.
LayerBase layerBase(const SurfaceMesh& surface);

/// The direction in which each vertex of the base moves, a unit vector into the lumen. It is that of the
/// gradient of the field that the surface follows: of the blended field of `source`, kept off other
/// vessels by `gap` mm. Where a triangle would be turned over by it, as behind a sharp edge, and on
/// flow extensions, where there is no field, it is turned towards the normals of the triangles.
/// Rims stay in their planes.
std::vector<Eigen::Vector3d> layerDirections(const LayerBase& base, const SurfaceMesh& surface,
                                             const formats::Case& source, double gap);

}  // namespace lumen::convert
