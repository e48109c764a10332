// SPDX-License-Identifier: Apache-2.0
// VTK's XML format. VTK itself is too heavy to link for one writer.
// Declared in write_plain.h.
#include <cstdint>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vtk_array.h"
#include "converters/io/mesh/write_options.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {
namespace {

std::string fieldData(const SurfaceMesh& surface, const std::string& unit) {
  std::vector<std::string> kinds;
  for (const FaceGroup& group : surface.groups) kinds.emplace_back(faceKindName(group.kind));
  return "<FieldData>\n" + textArray("GroupNames", plainGroupNames(surface.groups)) +
         textArray("GroupKinds", kinds) + textArray("BranchLabels", surface.labels) +
         (surface.systems.empty() ? "" : textArray("BranchSystems", systemNames(surface))) +
         textArray("Unit", {unit}) + textArray("SPACE", {"LPS"}) +
         textArray("Generator", {"lumen " LUMEN_VERSION}) + "</FieldData>\n";
}

std::string pointData(const SurfaceMesh& surface) {
  const std::vector<std::int32_t> branch(surface.branch.begin(), surface.branch.end());
  std::string out = "<PointData Scalars=\"Radius\" Normals=\"Normals\">\n" +
                    dataArray("Float32", "Normals", 3, surface.normal) +
                    dataArray("Float32", "Radius", 1, surface.radius) +
                    dataArray("Int32", "Branch", 1, branch);
  if (!surface.confidence.empty()) out += dataArray("Float32", "Confidence", 1, surface.confidence);
  return out + "</PointData>\n";
}

std::string cellData(const SurfaceMesh& surface) {
  std::vector<std::int32_t> number;
  number.reserve(surface.group.size());
  for (const std::uint32_t group : surface.group)
    number.push_back(static_cast<std::int32_t>(group) + 1);
  return "<CellData Scalars=\"ModelFaceID\">\n" + dataArray("Int32", "ModelFaceID", 1, number) +
         dataArray("Int32", "CellEntityIds", 1, number) + "</CellData>\n";
}

std::string polygons(const SurfaceMesh& surface) {
  std::vector<std::int64_t> corner, end;
  corner.reserve(3 * surface.triangle.size());
  end.reserve(surface.triangle.size());
  for (const Triangle& t : surface.triangle) {
    corner.insert(corner.end(), t.begin(), t.end());
    end.push_back(static_cast<std::int64_t>(corner.size()));
  }
  return "<Polys>\n" + dataArray("Int64", "connectivity", 1, corner) +
         dataArray("Int64", "offsets", 1, end) + "</Polys>\n";
}

}  // namespace

std::string encodeVtp(const SurfaceMesh& surface) {
  return encodeVtpIn(surface, "mm");
}

std::string encodeVtpIn(const SurfaceMesh& surface, const std::string& unit) {
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n" +
         fieldData(surface, unit) + "<Piece NumberOfPoints=\"" +
         std::to_string(surface.position.size()) +
         "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(surface.triangle.size()) + "\">\n" + pointData(surface) +
         cellData(surface) + "<Points>\n" + dataArray("Float32", "Points", 3, surface.position) +
         "</Points>\n" + polygons(surface) + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace lumen::convert
