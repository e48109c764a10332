// SPDX-License-Identifier: Apache-2.0
// VTK's XML format for cells. Declared in volume_mesh.h.
#include <cstdint>
#include <string>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/volume_mesh.h"
#include "converters/io/mesh/vtk_array.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

namespace {

// VTK's numbers of kinds of cells
constexpr std::uint8_t kVtkTriangle = 5, kVtkQuad = 9, kVtkTetra = 10, kVtkWedge = 13;

/// Arrays of VTK's cells while they are gathered.
struct VtkCells {
  std::vector<std::int64_t> corner, end;
  std::vector<std::uint8_t> type;
  std::vector<std::int32_t> face;  // number of the group; 0: a cell of the inside

  template <class Corners>
  void add(const Corners& corners, std::uint8_t kind, std::int32_t group) {
    for (const std::uint32_t c : corners)
      if (c != kAbsent) corner.push_back(c);
    end.push_back(static_cast<std::int64_t>(corner.size()));
    type.push_back(kind);
    face.push_back(group);
  }
};

VtkCells cellsOf(const VolumeMesh& mesh) {
  VtkCells cells;
  for (const auto& prism : mesh.prism) cells.add(prism, kVtkWedge, 0);
  for (const auto& tetrahedron : mesh.tetrahedron) cells.add(tetrahedron, kVtkTetra, 0);
  for (const BoundaryFace& face : mesh.boundary)
    cells.add(face.corner, face.corner[3] == kAbsent ? kVtkTriangle : kVtkQuad,
              static_cast<std::int32_t>(face.group) + 1);
  return cells;
}

}  // namespace

std::string encodeVtu(const VolumeMesh& mesh) {
  const VtkCells cells = cellsOf(mesh);
  std::vector<double> place;
  place.reserve(3 * mesh.position.size());
  for (const Eigen::Vector3d& p : mesh.position) place.insert(place.end(), p.begin(), p.end());
  std::vector<std::string> kinds;
  for (const FaceGroup& group : mesh.groups) kinds.emplace_back(faceKindName(group.kind));
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n"
         "<FieldData>\n" +
         textArray("GroupNames", plainGroupNames(mesh.groups)) + textArray("GroupKinds", kinds) +
         textArray("Unit", {"mm"}) + textArray("SPACE", {"LPS"}) +
         textArray("Generator", {"lumen " LUMEN_VERSION}) +
         "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(mesh.position.size()) +
         "\" NumberOfCells=\"" + std::to_string(cells.type.size()) +
         "\">\n<CellData Scalars=\"ModelFaceID\">\n" +
         dataArray("Int32", "ModelFaceID", 1, cells.face) +
         dataArray("Int32", "CellEntityIds", 1, cells.face) + "</CellData>\n<Points>\n" +
         dataArray("Float64", "Points", 3, place) + "</Points>\n<Cells>\n" +
         dataArray("Int64", "connectivity", 1, cells.corner) +
         dataArray("Int64", "offsets", 1, cells.end) + dataArray("UInt8", "types", 1, cells.type) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace lumen::convert
