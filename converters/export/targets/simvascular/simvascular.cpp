// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/cells.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/volume_mesh.h"
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

/// Tetrahedra with the owner of each face of their boundary and their connected parts.
struct NumberedMesh {
  VolumeMesh mesh;
  std::vector<CellFace> boundary;
  std::vector<std::int32_t> region;  // of each cell: 1, 2, ...
};

NumberedMesh numbered(VolumeMesh mesh) {
  NumberedMesh result{std::move(mesh), {}, {}};
  for (const CellFace& face : cellFaces(result.mesh))
    if (face.neighbour == kAbsent) result.boundary.push_back(face);
  DisjointSets sets(result.mesh.position.size());
  for (const auto& t : result.mesh.tetrahedron)
    for (const std::uint32_t v : t) sets.join(t[0], v);
  std::map<std::uint32_t, std::int32_t> numbers;
  for (const auto& t : result.mesh.tetrahedron)
    result.region.push_back(
        numbers.emplace(sets.find(t[0]), static_cast<std::int32_t>(numbers.size() + 1))
            .first->second);
  return result;
}

/// Some faces of the boundary as triangles, with the numbers that they and their points have in the
/// volume mesh, from 1.
template <class Takes>
std::string encodeFaces(const NumberedMesh& volume, const Takes& takesGroup) {
  std::vector<std::uint32_t> at(volume.mesh.position.size(), kAbsent);
  std::vector<std::array<double, 3>> position;
  std::vector<std::int32_t> node, elementOf, number, region;
  std::vector<std::int64_t> corner, end;
  for (const CellFace& face : volume.boundary) {
    if (!takesGroup(face.group)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = face.corner[k];
      if (at[v] == kAbsent) {
        at[v] = static_cast<std::uint32_t>(position.size());
        const Eigen::Vector3d& p = volume.mesh.position[v];
        position.push_back({p.x(), p.y(), p.z()});
        node.push_back(static_cast<std::int32_t>(v + 1));
      }
      corner.push_back(at[v]);
    }
    end.push_back(static_cast<std::int64_t>(corner.size()));
    elementOf.push_back(static_cast<std::int32_t>(face.owner + 1));
    number.push_back(static_cast<std::int32_t>(face.group + 1));
    region.push_back(volume.region[face.owner]);
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
         dataArray("Int32", "ModelFaceID", 1, number) +
         dataArray("Int32", "ModelRegionID", 1, region) + "</CellData>\n<Points>\n" +
         dataArray("Float64", "Points", 3, position) + "</Points>\n<Polys>\n" +
         dataArray("Int64", "connectivity", 1, corner) + dataArray("Int64", "offsets", 1, end) +
         "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string encodeCells(const NumberedMesh& volume) {
  constexpr std::uint8_t kTetrahedron = 10;  // VTK's number
  const VolumeMesh& mesh = volume.mesh;
  std::vector<std::int32_t> node(mesh.position.size()), elementOf(mesh.tetrahedron.size());
  std::vector<std::array<double, 3>> position;
  for (std::size_t k = 0; k < node.size(); ++k) {
    node[k] = static_cast<std::int32_t>(k + 1);
    const Eigen::Vector3d& p = mesh.position[k];
    position.push_back({p.x(), p.y(), p.z()});
  }
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
         dataArray("Int32", "ModelRegionID", 1, volume.region) + "</CellData>\n<Points>\n" +
         dataArray("Float64", "Points", 3, position) + "</Points>\n<Cells>\n" +
         dataArray("Int64", "connectivity", 1, corner) + dataArray("Int64", "offsets", 1, end) +
         dataArray("UInt8", "types", 1, types) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

void addMeshComplete(ExportResult& result, const SurfaceMesh& surface, const NumberedMesh& volume,
                     const std::vector<std::string>& names) {
  const auto isWall = [&](std::uint32_t g) { return surface.groups[g].kind == FaceKind::Wall; };
  const std::string folder = "mesh-complete/";
  result.files.push_back({folder + "mesh-complete.mesh.vtu", encodeCells(volume),
                          "tetrahedra, in layers at the wall", ""});
  result.files.push_back({folder + "mesh-complete.exterior.vtp",
                          encodeFaces(volume, [](std::uint32_t) { return true; }), "their boundary",
                          ""});
  result.files.push_back(
      {folder + "walls_combined.vtp", encodeFaces(volume, isWall), "the wall of it", ""});
  for (std::uint32_t g = 0; g < names.size(); ++g)
    if (std::find(surface.group.begin(), surface.group.end(), g) != surface.group.end())
      result.files.push_back({folder + "mesh-surfaces/" + names[g] + ".vtp",
                              encodeFaces(volume, [g](std::uint32_t other) { return other == g; }),
                              "", ""});
  result.others.push_back({folder + "mesh-surfaces/*.vtp", "each face of the model"});
  result.remarks.push_back(std::to_string(volume.mesh.tetrahedron.size()) + " tetrahedra, " +
                           std::to_string(volume.mesh.position.size()) + " nodes");
}

/// The cells within the surface in mm, in the target's frame: without layers where there can be none;
/// nothing where there are none either. The reasons are among the losses.
std::optional<MadeVolumeMesh> cellsOrWhy(const ExportInput& input, const ExportedSurface& surface,
                                         ExportResult& result) {
  CommonOptions options = input.options;
  const ExportInput other{input.source, options, input.frame, input.progress};
  std::string why;
  while (true) {
    try {
      MadeVolumeMesh made = cellsWithin(other, surface.mesh, surface.report.gap);
      if (!why.empty()) result.losses.push_back("the volume mesh has no layers: " + why);
      return made;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::Cancelled) throw;
      why = error.what();
    }
    if (options.volume.layers == 0) break;
    options.volume.layers = 0;
  }
  result.losses.push_back("there is no volume mesh: " + why);
  return {};
}

}  // namespace

ExportResult exportSimVascular(const ExportInput& input) {
  const std::vector<BranchPath> paths = branchPaths(input.source.tree);
  const ExportInput inMillimetres{input.source, input.options, {}, input.progress};
  ExportedSurface made = lumenSurface(inMillimetres);
  ExportResult result;
  const std::optional<MadeVolumeMesh> cells = cellsOrWhy(input, made, result);
  made.mesh = input.frame.of(std::move(made.mesh));
  const std::vector<std::string> names = distinct(plainGroupNames(made.mesh.groups), openFoamWord);
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
  for (std::string& loss : treeLosses(input.source.tree, "a set of paths"))
    result.losses.push_back(std::move(loss));
  if (cells) {
    result.remarks.push_back(cellsSentence(cells->report) +
                             ", each prism divided into three tetrahedra");
    addMeshComplete(result, made.mesh, numbered(asTetrahedra(cells->mesh)), names);
  }
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow simVascularRow() {
  return {
      .name = "simvascular",
      .title = "SimVascular",
      .files = {"vessels.svproj", "Models/vessel.mdl", "Models/vessel.vtp"},
      .units = {LengthUnit::Centimetre},
      .axes = {Axes::Lps},
      .holds =
          "branches as paths, radii as circles; the surface with its named ends; a volume "
          "mesh with layers at the wall, by Netgen if lumen has it",
      .lacks = "links that close loops, and that an aneurysm is one",
      .options = {"edge", "max-error", "triangles", "extend", "layers", "growth", "layer-height"}};
}

}  // namespace lumen::convert
