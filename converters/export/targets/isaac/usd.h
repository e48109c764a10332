// SPDX-License-Identifier: Apache-2.0
// Vessels as a stage of USD, in text (.usda).
#pragma once

#include <string>
#include <vector>

#include "converters/export/shared/frame.h"
#include "converters/export/shared/insertion.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// /vessel, the default prim, with
///   wall        the mesh, a collider as it is (UsdPhysics) or as a signed distance field (PhysX),
///   centerline  linear BasisCurves, one for each branch, whose widths are the vessels' diameters,
///   ends        an Xform for each end: in its middle, its z axis out of the vessel.
/// `mesh` is in `frame`, which the stage's metersPerUnit and upAxis state; tree and ends are mm,
/// LPS. Names are made fit for USD; custom strings `lumen:name` keep them. Where the mesh states
/// systems of vessels, wall and curves have their colours, and the curves `lumen:systems`.
std::string encodeUsda(const SurfaceMesh& mesh, const formats::CenterlineTree& tree,
                       const std::vector<NamedEnd>& ends, const ExportFrame& frame);

}  // namespace lumen::convert
