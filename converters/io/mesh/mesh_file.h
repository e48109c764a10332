// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of other programs, in. Files are hostile: counts are compared with the bytes that
// are there before anything is allocated, indices and coordinates are checked as they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

enum class MeshFormat : std::uint8_t { Stl, Obj, Ply, Gltf, Vtp, Vtk };

/// A mesh as its file has it: nothing is repaired, and triangles may be of any orientation.
struct MeshFile {
  /// The mesh has the file's unit, and the axes that the file names are turned to LPS. glTF, in
  /// metres with +Y up by its standard, becomes mm and LPS. There is at least one triangle,
  /// coordinates are finite and below 1e12, indices are in range. Equal points of STL are one.
  TriangleMesh mesh;
  std::vector<std::string>
      groups;  ///< names that the file has for sets of triangles, as it has them
  std::vector<std::uint32_t>
      group;                 ///< of each triangle: index into `groups`; empty if there are none
  double unitMm = 0;         ///< mm in one unit of `mesh`, if the file says so; otherwise 0
  bool frameStated = false;  ///< the file names its axes
  /// Assumptions, and parts that were passed over: a sentence each, fit to print.
  std::vector<std::string> notes;
};

/// Reads a file of that format: STL (ASCII or binary, several solids), OBJ (polygons become fans),
/// PLY (ASCII, little and big endian), glTF (GLB or text; buffers inside the file or in its folder;
/// Draco), VTP (ascii, base64, appended, zlib) and VTK's legacy PolyData. Lines and points of a file
/// are passed over. Throws Error(InvalidInput) with the file, the place in it, what was found and
/// what was expected, and Error(Unsupported) for what the format allows and this reader does not.
MeshFile readMesh(const std::filesystem::path& file, MeshFormat format);

/// Reads the bytes of a file as readMesh() does; `file` is for messages, and for the folder of
/// glTF's buffers.
MeshFile parseMesh(std::string_view bytes, const std::filesystem::path& file, MeshFormat format);

}  // namespace lumen::convert
