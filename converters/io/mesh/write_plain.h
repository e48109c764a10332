// SPDX-License-Identifier: Apache-2.0
// Meshes as the bytes of OBJ, STL and PLY files, in mm, LPS. Equal meshes give equal bytes. Files
// state SPACE=LPS where their format permits, for 3D Slicer.
#pragma once

#include <string>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// Wavefront OBJ: one group ("g") for each non-empty group of faces, named by oneWord(); flat ends
/// have normals of their own.
std::string encodeObj(const SurfaceMesh& surface);

/// STL. Binary: all faces in one solid. Text if `solids`: one for each non-empty group of faces,
/// named by openFoamWord(). Throws Error(Unsupported) for more faces than STL can count.
std::string encodeStl(const SurfaceMesh& surface, bool solids);

/// Binary little-endian PLY: normal, radius (mm), branch and, where known, confidence of each
/// vertex; the number of its group for each face; comments name branches and groups. Throws
/// Error(Unsupported) for more vertices or faces than PLY can count.
std::string encodePly(const SurfaceMesh& surface);

// Meshes as the bytes of VTK XML PolyData (.vtp), mm, LPS. Equal meshes give equal bytes.

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
