// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/print/three_mf.h"
#include "converters/export/targets/targets.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {

namespace {

// mm: walls that printers of resin and powder hold without support
constexpr Length kPrintedWall = {1, 0};
// mm: thinner walls of resin tear (makers' guides: 0.4 to 0.8)
constexpr double kLeastPrintable = .6;

struct Thinnest {
  double thickness = 0;  ///< mm
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

/// The least distance of a vertex of the lumen's side from the outer one. The mesh is a wall of
/// closedSurface(): group 0 is the lumen's side, group 1 the outer one.
Thinnest findThinnest(const SurfaceMesh& mesh) {
  TriangleMesh outer;
  for (const Float3& p : mesh.position) outer.position.push_back(toEigen(p));
  std::vector<char> isInner(mesh.position.size(), 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (mesh.group[t] == 1) outer.triangle.push_back(mesh.triangle[t]);
    if (mesh.group[t] == 0)
      for (const std::uint32_t v : mesh.triangle[t]) isInner[v] = 1;
  }
  const TriangleTree tree(outer);
  Thinnest least{std::numeric_limits<double>::infinity(), {}};
  for (std::size_t v = 0; v < isInner.size(); ++v) {
    if (isInner[v] == 0) continue;
    const double distance = tree.nearest(outer.position[v], least.thickness).distance;
    if (distance < least.thickness) least = {distance, outer.position[v]};
  }
  return least;
}

std::string thicknessText(const Thinnest& least) {
  return "the wall is thinnest, " + fixedText(least.thickness, 2) + " mm, at (" +
         fixedText(least.place.x(), 2) + ", " + fixedText(least.place.y(), 2) + ", " +
         fixedText(least.place.z(), 2) + ") mm";
}

void addSolid(ExportResult& result, const std::string& name, const SurfaceMesh& mesh,
              const std::string& about) {
  result.files.push_back({name + ".3mf", encode3mf(mesh, name), about, ""});
  result.files.push_back({name + ".stl", encodeStl(mesh, false), "the same", ""});
}

}  // namespace

ExportResult exportPrint(const ExportInput& input) {
  ExportResult result;
  ExportedSurface core = lumenSurface(input);
  addSolid(result, "core", core.mesh, "the lumen as a solid");
  result.start = exportText("print/README.md");
  result.ends = std::move(core.ends);
  ExportedSurface wall = wallSurface(input, kPrintedWall);
  const Thinnest least = findThinnest(wall.mesh);
  addSolid(result, "wall", wall.mesh, "a wall around the lumen as a solid");
  result.remarks.push_back(thicknessText(least));
  result.start += "\nChecked: " + thicknessText(least) + ".\n";
  if (least.thickness < kLeastPrintable)
    result.losses.push_back(
        thicknessText(least) + ", less than the " + fixedText(kLeastPrintable, 2) +
        " mm that most printers hold; a greater " + input.field("thickness") + " may help");
  result.surface = std::move(wall.report);
  return result;
}

TargetRow printRow() {
  return {.name = "print",
          .title = "3D printers",
          .files = {"core.3mf", "core.stl", "wall.3mf", "wall.stl"},
          .units = {LengthUnit::Millimetre},
          .axes = {Axes::Lps},
          .holds = "the lumen as a solid; a wall around it, with its least thickness",
          .lacks = "the tree, its radii and its models",
          .options = {"edge", "max-error", "thickness"},
          .needsVessel = false};
}

}  // namespace lumen::convert
