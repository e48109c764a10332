// SPDX-License-Identifier: Apache-2.0
// Readers of triangle meshes of other programs. Files are hostile: counts are compared with the
// available bytes before anything is allocated, indices and coordinates are checked as they are
// read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "converters/io/mesh/mesh_readers.h"

namespace lumen::convert {

enum class MeshFormat : std::uint8_t { Stl, Obj, Ply, Gltf, Vtp, Vtk };

/// Reads a file of the given format: STL (ASCII or binary, several solids), OBJ (polygons become
/// fans), PLY (ASCII, little and big endian), glTF (GLB or text; buffers inside the file or in its
/// folder; Draco), VTP (ascii, base64, appended, zlib) and VTK's legacy PolyData. Lines and points
/// of a file are ignored. Throws Error(InvalidInput) with the file, the place in it, the fault and
/// the expectation, and Error(Unsupported) for legal parts of a format that this reader lacks.
MeshFile readMesh(const std::filesystem::path& file, MeshFormat format);

/// Reads a mesh from the bytes of a file; `file` serves messages, and its folder holds glTF's
/// buffers. Throws as readMesh() does.
MeshFile parseMesh(std::string_view bytes, const std::filesystem::path& file, MeshFormat format);

}  // namespace lumen::convert
