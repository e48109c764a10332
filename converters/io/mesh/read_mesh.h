// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of other programs, in. Files are hostile: counts are compared with the bytes that
// are there before anything is allocated, indices and coordinates are checked as they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

enum class MeshFormat : std::uint8_t { Stl, Obj, Ply, Gltf, Vtp, Vtk };

/// Reads a file of that format: STL (ASCII or binary, several solids), OBJ (polygons become fans),
/// PLY (ASCII, little and big endian), glTF (GLB or text; buffers inside the file or in its folder;
/// Draco), VTP (ascii, base64, appended, zlib) and VTK's legacy PolyData. Lines and points of a file
/// are passed over. Throws Error(InvalidInput) with the file, the place in it, the fault and the
/// expectation, and Error(Unsupported) for legal parts of a format that this reader lacks.
MeshFile readMesh(const std::filesystem::path& file, MeshFormat format);

/// Reads a mesh from the bytes of a file; `file` is for messages, and for the folder of glTF's
/// buffers. Throws as readMesh() does.
MeshFile parseMesh(std::string_view bytes, const std::filesystem::path& file, MeshFormat format);

}  // namespace lumen::convert
