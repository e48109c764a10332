// SPDX-License-Identifier: Apache-2.0
// Meshes as the bytes of VTK XML PolyData (.vtp), mm, LPS. Equal meshes give equal bytes.
#pragma once

#include <string>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// Arrays are zlib-compressed and base64-coded inline, which every VTK from 5 on reads.
///
/// Points: Normals, Radius (mm), Branch (index into BranchLabels) and, where known, Confidence.
/// Cells: the number of their group, as ModelFaceID for SimVascular and as CellEntityIds for VMTK.
/// Field data, as texts: GroupNames and GroupKinds in the order of numbers, BranchLabels, Unit
/// (mm), Generator, and SPACE (LPS), for 3D Slicer.
///
/// Throws Error(Failed) if zlib refuses.
std::string encodeVtp(const SurfaceMesh& surface);

/// A VTP file of a surface whose lengths are in `unit`, which the file states.
std::string encodeVtpIn(const SurfaceMesh& surface, const std::string& unit);

}  // namespace lumen::convert
