// SPDX-License-Identifier: Apache-2.0
// The surface of a case in the form for writers of meshes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

// Values of a tree at a place on the wall.

struct VesselValues {
  float radius = 0;                 ///< mm
  std::optional<float> confidence;  ///< the inlier rate, in [0, 1]; nothing if the tree has none
};

/// The values of the nodes, linear along the edges of the tree that end in `node`, at the point of
/// these edges nearest to `point`, mm, LPS.
VesselValues vesselAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                      const Eigen::Vector3d& point, std::uint32_t node);

enum class Normals : std::uint8_t {
  OfTriangles,  ///< the mean of those around a vertex, by area
  OfField       ///< the field's gradient, where it looks as the triangles do
};

/// A surface as a mesh for writers: its vertices, triangles and groups, the labels of the case that
/// `field` is of, and at each vertex the radius and the inlier rate of its place along the vessel.
/// Normals point outward; vertices within a flat end have the end's. Throws Error(Cancelled).
SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SeparatedField& field, Normals normals,
                          Progress& progress);

// The motion of a case as bones of its surface, for programs that know linear blend skinning.

/// Bones of the surfaces of a case with models and a motion. A joint is a moving node whose blobs
/// take part; all resting nodes share one. A vertex hangs on the nodes whose local fields blend at
/// its place at rest, with their weights there, on the four greatest of them if there are more: to
/// first order it then stays on the wall of the posed case (spec/lumen.md, "The posed case"). A periodic
/// motion ends with the poses that it begins with.
MeshSkin skinOf(const formats::Case& source, const std::vector<SurfaceMesh>& levels);

}  // namespace lumen::convert
