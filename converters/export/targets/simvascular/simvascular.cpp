// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vtk_array.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {

namespace {

std::string point(std::size_t id, const Eigen::Vector3d& mm) {
  return pointElement("point id=\"" + std::to_string(id) + "\"", kCentimetres * mm);
}

/// The circle of a node, as SimVascular draws one by hand: its middle, a point on it, and points
/// around.
std::string contour(const BranchPath& path, std::size_t k, std::size_t id) {
  constexpr int kAround = 40;
  const Eigen::Vector3d tangent = path.tangent(k);
  const auto [u, v] = planeBasis(tangent);
  const double r = path.radii[k];
  std::string points;
  for (int n = 0; n < kAround; ++n) {
    const double angle = 2 * std::numbers::pi * n / kAround;
    points += point(static_cast<std::size_t>(n),
                    path.points[k] + r * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return exportText("simvascular/contour.xml",
                    {{"id", std::to_string(id)},
                     {"node", std::to_string(k)},
                     {"frame", pointElement("pos", kCentimetres * path.points[k]) +
                                   pointElement("tangent", tangent) + pointElement("rotation", u)},
                     {"controls", point(0, path.points[k]) + point(1, path.points[k] + r * u)},
                     {"points", points}});
}

/// The nodes of a path with a contour: its last one, and those before it that are a radius apart;
/// none on the parent's axis.
std::vector<std::size_t> sections(const BranchPath& path, bool hasParent) {
  std::vector<std::size_t> chosen;
  double along = 0, last = 0;
  const std::size_t first = hasParent ? 1 : 0, end = path.points.size() - 1;
  for (std::size_t k = first; k <= end; ++k) {
    if (k > first) along += (path.points[k] - path.points[k - 1]).norm();
    if (k > first && k < end && along - last < path.radii[k]) continue;
    chosen.push_back(k);
    last = along;
  }
  return chosen;
}

std::string encodeCtgr(const BranchPath& path, std::size_t id, bool hasParent) {
  std::string contours;
  std::size_t number = 0;
  for (const std::size_t k : sections(path, hasParent)) contours += contour(path, k, number++);
  return exportText("simvascular/segmentation.ctgr",
                    {{"name", path.name}, {"id", std::to_string(id)}, {"contours", contours}});
}

std::string encodeMdl(const SurfaceMesh& mesh, const std::vector<std::string>& names) {
  std::string faces;
  for (std::size_t g = 0; g < names.size(); ++g) {
    const bool isWall = mesh.groups[g].kind == FaceKind::Wall;
    faces += exportText("simvascular/face.xml", {{"id", std::to_string(g + 1)},
                                                 {"name", names[g]},
                                                 {"type", isWall ? "wall" : "cap"},
                                                 {"colour", isWall ? "1" : "0.5"}});
  }
  return exportText("simvascular/vessel.mdl", {{"faces", faces}});
}

/// Some of the surface's triangles, with the numbers that they and their points have in the volume
/// mesh, from 1.
class Faces {
public:
  Faces(const SurfaceMesh& surface, const VolumeMesh& volume)
      : m_surface(surface), m_volume(volume) {}

  template <class Takes>
  std::string encode(const Takes& takesGroup) const {
    std::vector<std::uint32_t> at(m_surface.position.size(), UINT32_MAX);
    std::vector<std::array<double, 3>> position;
    std::vector<std::int32_t> node, elementOf, face, region;
    std::vector<std::int64_t> corner, end;
    for (std::size_t t = 0; t < m_surface.triangle.size(); ++t) {
      if (!takesGroup(m_surface.group[t])) continue;
      for (const std::uint32_t v : m_surface.triangle[t]) {
        if (at[v] == UINT32_MAX) {
          at[v] = static_cast<std::uint32_t>(position.size());
          position.push_back(m_volume.position[v]);
          node.push_back(static_cast<std::int32_t>(v + 1));
        }
        corner.push_back(at[v]);
      }
      end.push_back(static_cast<std::int64_t>(corner.size()));
      const std::uint32_t e = m_volume.elementOf[t];
      elementOf.push_back(static_cast<std::int32_t>(e + 1));
      face.push_back(static_cast<std::int32_t>(m_surface.group[t] + 1));
      region.push_back(static_cast<std::int32_t>(m_volume.region[e]));
    }
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
           "byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n<Piece "
           "NumberOfPoints=\"" +
           std::to_string(position.size()) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
           std::to_string(end.size()) + "\">\n<PointData>\n" +
           dataArray("Int32", "GlobalNodeID", 1, node) + "</PointData>\n<CellData>\n" +
           dataArray("Int32", "GlobalElementID", 1, elementOf) +
           dataArray("Int32", "ModelFaceID", 1, face) +
           dataArray("Int32", "ModelRegionID", 1, region) + "</CellData>\n<Points>\n" +
           dataArray("Float64", "Points", 3, position) + "</Points>\n<Polys>\n" +
           dataArray("Int64", "connectivity", 1, corner) + dataArray("Int64", "offsets", 1, end) +
           "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  }

private:
  const SurfaceMesh& m_surface;
  const VolumeMesh& m_volume;
};

std::string encodeVtu(const VolumeMesh& mesh) {
  constexpr std::uint8_t kTetrahedron = 10;  // VTK's number
  std::vector<std::int32_t> node(mesh.position.size()), elementOf(mesh.tetrahedron.size()),
      region(mesh.region.begin(), mesh.region.end());
  for (std::size_t k = 0; k < node.size(); ++k) node[k] = static_cast<std::int32_t>(k + 1);
  std::vector<std::int64_t> corner, end;
  for (std::size_t k = 0; k < elementOf.size(); ++k) {
    elementOf[k] = static_cast<std::int32_t>(k + 1);
    corner.insert(corner.end(), mesh.tetrahedron[k].begin(), mesh.tetrahedron[k].end());
    end.push_back(static_cast<std::int64_t>(corner.size()));
  }
  const std::vector<std::uint8_t> types(mesh.tetrahedron.size(), kTetrahedron);
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<Piece "
         "NumberOfPoints=\"" +
         std::to_string(node.size()) + "\" NumberOfCells=\"" + std::to_string(elementOf.size()) +
         "\">\n<PointData>\n" + dataArray("Int32", "GlobalNodeID", 1, node) +
         "</PointData>\n<CellData>\n" + dataArray("Int32", "GlobalElementID", 1, elementOf) +
         dataArray("Int32", "ModelRegionID", 1, region) + "</CellData>\n<Points>\n" +
         dataArray("Float64", "Points", 3, mesh.position) + "</Points>\n<Cells>\n" +
         dataArray("Int64", "connectivity", 1, corner) + dataArray("Int64", "offsets", 1, end) +
         dataArray("UInt8", "types", 1, types) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

void addMeshComplete(ExportResult& result, const SurfaceMesh& surface, const VolumeMesh& volume,
                     const std::vector<std::string>& names) {
  const Faces faces(surface, volume);
  const auto isWall = [&](std::uint32_t g) { return surface.groups[g].kind == FaceKind::Wall; };
  const std::string folder = "mesh-complete/";
  result.files.push_back(
      {folder + "mesh-complete.mesh.vtu", encodeVtu(volume), "tetrahedra, by TetGen", ""});
  result.files.push_back({folder + "mesh-complete.exterior.vtp",
                          faces.encode([](std::uint32_t) { return true; }), "their boundary", ""});
  result.files.push_back(
      {folder + "walls_combined.vtp", faces.encode(isWall), "the wall of it", ""});
  for (std::uint32_t g = 0; g < names.size(); ++g)
    if (std::find(surface.group.begin(), surface.group.end(), g) != surface.group.end())
      result.files.push_back({folder + "mesh-surfaces/" + names[g] + ".vtp",
                              faces.encode([g](std::uint32_t other) { return other == g; }), "",
                              ""});
  result.others.push_back({folder + "mesh-surfaces/*.vtp", "each face of the model"});
  result.remarks.push_back(std::to_string(volume.tetrahedron.size()) + " tetrahedra, " +
                           std::to_string(volume.position.size()) + " nodes");
}

}  // namespace

ExportResult exportSimVascular(const ExportInput& input) {
  const std::vector<BranchPath> paths = branchPaths(input.source.tree);
  ExportedSurface made = lumenSurface(input);
  const std::vector<std::string> names = distinct(plainGroupNames(made.mesh.groups), openFoamWord);
  ExportResult result;
  result.start = exportText("simvascular/README.md");
  result.files = {
      {"vessels.svproj", exportText("simvascular/vessels.svproj"), "the project", ""},
      {"Models/vessel.mdl", encodeMdl(made.mesh, names), "the model's faces: wall and caps", ""},
      {"Models/vessel.vtp", encodeVtpIn(made.mesh, "cm"), "the model, with `ModelFaceID`", ""}};
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const bool hasParent = input.source.tree.branches[paths[k].branch].parentNode >= 0;
    result.files.push_back({"Paths/" + paths[k].name + ".pth", encodePth(paths[k], k + 1), "", ""});
    result.files.push_back({"Segmentations/" + paths[k].name + ".ctgr",
                            encodeCtgr(paths[k], k + 1, hasParent), "", ""});
  }
  result.others = {{"Paths/*.pth", "centerlines"},
                   {"Segmentations/*.ctgr", "circles of the nodes' radii"}};
  result.losses = treeLosses(input.source.tree);
  std::string why;
  if (const auto volume = volumeMesh(made.mesh, input.options.word, input.progress, why))
    addMeshComplete(result, made.mesh, *volume, names);
  else
    result.losses.push_back(why);
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow simVascularRow() {
  return {.name = "simvascular",
          .title = "SimVascular",
          .files = {"vessels.svproj", "Models/vessel.mdl", "Models/vessel.vtp"},
          .units = {LengthUnit::Centimetre},
          .axes = {Axes::Lps},
          .holds =
              "branches as paths, radii as circles; the surface with its named ends; a volume "
              "mesh, by TetGen if it is installed",
          .lacks = "links that close loops, and that an aneurysm is one",
          .options = {"edge", "max-error", "triangles", "extend"}};
}

}  // namespace lumen::convert
