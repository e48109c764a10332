// SPDX-License-Identifier: Apache-2.0
// Readers of triangle meshes of other programs. Files are hostile: counts are compared with the
// available bytes before anything is allocated, indices and coordinates are checked as they are
// read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/io/vtk/stored_number.h"

namespace lumen::convert {

// Triangle mesh as stored in a file of another program.

/// The note on a file that states RAS.
constexpr const char* kTurnedNote = "the file states RAS: x and y were negated, to LPS";

/// A mesh as stored in its file: nothing is repaired, and triangles may have any orientation.
struct MeshFile {
  /// The mesh has the file's unit, and the axes that the file names are turned to LPS. glTF, in
  /// metres with +Y up by its standard, becomes mm and LPS. There is at least one triangle,
  /// coordinates are finite and below 1e12, indices are in range. Equal points of STL are merged.
  TriangleMesh mesh;
  std::vector<std::string> groups;   ///< names of sets of triangles in the file
  std::vector<std::uint32_t> group;  ///< index into `groups` of each triangle; empty: no groups
  double unitMm = 0;                 ///< mm in one unit of `mesh`; 0: the file states none
  double standardMm = 0;  ///< mm in one unit of the file by its format's standard, if `mesh` is in
                          ///< mm by it alone; else 0
  bool frameStated = false;  ///< the file names its axes
  bool isTurned = false;     ///< x and y were negated, as the file states RAS
  /// Assumptions and omissions of the reader, one printable sentence each.
  std::vector<std::string> notes;

  /// Factor of `mesh` that makes it mm, if `unit` mm are one unit of the file.
  [[nodiscard]] double scaleFor(double unit) const {
    return standardMm > 0 ? unit / standardMm : unit;
  }
};

// glTF 2.0 (Khronos), GLB or text.

/// The triangles of the file's scene in mm, LPS: placed by their nodes, converted from glTF's
/// metres with +Y up. Files of lumen are restored exactly. Primitives are groups, named by their
/// extras as lumen writes them, or else by their mesh. KHR_draco_mesh_compression and
/// KHR_mesh_quantization are read; materials, skins and animations are ignored.
MeshFile parseGltf(std::string_view bytes, const InputFile& file);

// Wavefront OBJ ("Advanced Visualizer Manual", appendix B1, 1992).

/// The faces of an OBJ file as triangles, polygons as fans. Indices may be negative. A group (g) or
/// else an object (o) of triangles is a group with its name. Lines, points, materials, normals and
/// texture are ignored; curved surfaces are too, with a note.
MeshFile parseObj(std::string_view bytes, const std::string& name);

// PLY (Turk, "The PLY polygon file format", 1994).

/// The faces of a PLY file as triangles, polygons as fans: ASCII, or binary of either byte order,
/// with any properties and elements besides x, y, z and vertex_indices (or vertex_index).
MeshFile parsePly(std::string_view bytes, const std::string& name);

// STL, binary and ASCII (3D Systems, "StereoLithography Interface Specification", 1989).

/// The triangles of an STL file, points of equal coordinates merged; a file is binary if its size
/// matches its count, or if it does not begin with "solid". Each solid of an ASCII file is a group
/// of its name. Normals and attributes are ignored: the order of corners gives the orientation.
MeshFile parseStl(std::string_view bytes, const std::string& name);

// Surfaces of VTK: XML (.vtp) and the legacy format (.vtk); VTK File Formats, Kitware.

/// The polygons (as fans) and strips of an XML PolyData file. The integers of a cell array
/// ModelFaceID are groups named by their numbers. Lines and points are ignored.
MeshFile parseVtp(std::string_view bytes, const std::string& name);

/// The polygons, strips and groups of a legacy file, versions 1 to 5, ASCII or binary. A file whose
/// title or field data state RAS, as 3D Slicer writes it, is turned to LPS.
MeshFile parseVtk(std::string_view bytes, const std::string& name);

// Decoder of one mesh from a Draco bit stream. Draco's headers stay behind this file.

struct DecodedDraco {
  std::vector<std::array<float, 3>> position;
  std::vector<Triangle> triangle;  ///< indices, unchecked
};

/// Decodes `bytes` into `points` and `triangles`, in a process of its own, because Draco allocates
/// the sizes that a stream announces; the attribute whose unique id is `position` holds the points.
/// Empty if the stream is damaged, holds other counts, or more than 64 points and triangles per
/// byte, a density that no coded surface reaches.
DecodedDraco decodeDracoMesh(std::string_view bytes, std::uint32_t position, std::size_t points,
                             std::size_t triangles);

// Surface segmentations of DICOM.

/// The surfaces of a file, in mm and LPS; each is a group with the name of its segment.
MeshFile readDicomSurface(const InputFile& file, const std::string& name);

enum class MeshFormat : std::uint8_t { Stl, Obj, Ply, Gltf, Vtp, Vtk, DicomSurface };

/// Reads a file of the given format: STL (ASCII or binary, several solids), OBJ (polygons become
/// fans), PLY (ASCII, little and big endian), glTF (GLB or text; buffers inside the file or in its
/// folder; Draco), VTP (ascii, base64, appended, zlib) and VTK's legacy PolyData. Lines and points
/// of a file are ignored. Throws Error(InvalidInput) with the file, the place in it, the fault and
/// the expectation, and Error(Unsupported) for legal parts of a format that this reader lacks.
MeshFile readMesh(const InputFile& file, MeshFormat format);

}  // namespace lumen::convert
