// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/openfoam.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/option_name.h"
#include "converters/export/shared/blood.h"
#include "converters/export/shared/export_text.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/targets/openfoam/openfoam_cells.h"
#include "converters/io/mesh/plain_names.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {

namespace {

/// A group of faces as a patch of the mesh.
struct Patch {
  std::string name;
  FaceKind kind = FaceKind::Wall;  ///< an end that is not flat is a wall
  double radius = 0;               ///< m
};

/// Most significant digits of a number in a dictionary of OpenFOAM.
constexpr int kFoamDigits = 12;

/// A vector of OpenFOAM, "(1 2.5 3)".
std::string foamVector(const Eigen::Vector3d& v) {
  return "(" + joinedNumbers(v, " ", kFoamDigits) + ")";
}

std::vector<Patch> makePatches(const SurfaceMesh& mesh, const std::vector<NamedEnd>& ends) {
  const std::vector<std::string> names = distinct(plainGroupNames(mesh.groups), openFoamWord);
  std::vector<Patch> patches;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (std::find(mesh.group.begin(), mesh.group.end(), g) == mesh.group.end()) continue;
    Patch patch{names[g], mesh.groups[g].kind, 0};
    if (patch.kind == FaceKind::Cap) patch.kind = FaceKind::Wall;
    for (const NamedEnd& end : ends)
      if (end.name == mesh.groups[g].name) patch.radius = 1e-3 * end.radius;
    patches.push_back(std::move(patch));
  }
  return patches;
}

void requireEnds(const std::vector<Patch>& patches) {
  for (const auto& [kind, name] :
       {std::pair(FaceKind::Inlet, "inlet"), std::pair(FaceKind::Outlet, "outlet")})
    if (std::none_of(patches.begin(), patches.end(),
                     [kind = kind](const Patch& p) { return p.kind == kind; }))
      throw invalidInput("the surface of this case has no flat " + std::string(name) +
                         ", so nothing can flow through it");
}

/// A line for each patch of a kind: its name in the place of {end}.
std::string forEach(const std::vector<Patch>& patches, FaceKind kind, std::string_view text) {
  std::string all;
  for (const Patch& patch : patches)
    if (patch.kind == kind) all += filled(text, {{"end", patch.name}});
  return all;
}

std::string blockMeshDict(const FoamCells& cells) {
  const Eigen::Vector3d size(cells.count[0], cells.count[1], cells.count[2]);
  std::string vertices, counts;
  for (const auto& corner : std::initializer_list<Eigen::Vector3d>{
           {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
    vertices += "    " + foamVector(cells.low + cells.edge() * size.cwiseProduct(corner)) + "\n";
  for (const int n : cells.count) counts += (counts.empty() ? "" : " ") + std::to_string(n);
  return exportText("openfoam/blockMeshDict", {{"vertices", vertices}, {"cells", counts}});
}

/// Number of times that cells are halved at a patch: at an end until six lie across, or the end of
/// a thin vessel were lost.
int levelAt(const Patch& patch, const FoamCells& cells) {
  constexpr double kAcrossEnd = 6;
  constexpr int kMostBeyond = 3;  // halvings more than at the wall
  if (patch.radius <= 0) return cells.level;
  const double halvings = std::ceil(std::log2(kAcrossEnd * cells.atWall / (2 * patch.radius)));
  return cells.level + std::clamp(static_cast<int>(halvings), 0, kMostBeyond);
}

std::string refinement(const Patch& patch, const FoamCells& cells) {
  const std::string level = std::to_string(levelAt(patch, cells));
  return "                " + patch.name + " { level (" + level + " " + level +
         "); patchInfo { type " + (patch.kind == FaceKind::Wall ? "wall" : "patch") + "; } }\n";
}

std::string snappyHexMeshDict(const std::vector<Patch>& patches, const FoamCells& cells,
                              const std::vector<Eigen::Vector3d>& inside) {
  std::string regions, refined, places;
  for (const Patch& patch : patches) {
    regions += "            " + patch.name + " { name " + patch.name + "; }\n";
    refined += refinement(patch, cells);
  }
  for (const Eigen::Vector3d& p : inside) places += " (" + foamVector(p) + " none)";
  return exportText("openfoam/snappyHexMeshDict",
                    {{"regions", regions},
                     {"level", std::to_string(cells.level)},
                     {"refinements", refined},
                     {"places", inside.size() == 1 ? "locationInMesh " + foamVector(inside.front())
                                                   : "locationsInMesh (" + places + " )"}});
}

std::string controlDict(const std::vector<Patch>& patches) {
  std::string flows;
  for (const FaceKind kind : {FaceKind::Inlet, FaceKind::Outlet})
    for (const Patch& patch : patches)
      if (patch.kind == kind) flows += exportText("openfoam/flow", {{"end", patch.name}});
  return exportText("openfoam/controlDict", {{"flows", flows}});
}

std::string velocity(const std::vector<Patch>& patches) {
  std::string inlets;
  for (const Patch& patch : patches)
    if (patch.kind == FaceKind::Inlet)
      inlets +=
          "    " + patch.name + " { type flowRateInletVelocity; volumetricFlowRate constant " +
          numberText(blood::meanFlow(patch.radius), kFoamDigits) + "; value uniform (0 0 0); }\n";
  return exportText(
      "openfoam/U",
      {{"walls", forEach(patches, FaceKind::Wall, "    {end} { type noSlip; }\n")},
       {"inlets", inlets},
       {"outlets", forEach(patches, FaceKind::Outlet,
                           "    {end} { type inletOutlet; inletValue uniform (0 0 0); "
                           "value uniform (0 0 0); }\n")}});
}

std::string pressure(const std::vector<Patch>& patches) {
  const char* const free = "    {end} { type zeroGradient; }\n";
  return exportText("openfoam/p",
                    {{"walls", forEach(patches, FaceKind::Wall, free)},
                     {"inlets", forEach(patches, FaceKind::Inlet, free)},
                     {"outlets", forEach(patches, FaceKind::Outlet,
                                         "    {end} { type fixedValue; value uniform 0; }\n")}});
}

std::vector<ExportFile> dictionaries(const std::vector<Patch>& patches, const FoamCells& cells,
                                     const std::vector<Eigen::Vector3d>& inside) {
  return {{"Allrun", exportText("openfoam/Allrun"), "makes the mesh and runs the flow", ""},
          {"system/blockMeshDict", blockMeshDict(cells), "cubes around the vessels", ""},
          {"system/surfaceFeatureExtractDict", exportText("openfoam/surfaceFeatureExtractDict"),
           "the rims of flat ends", ""},
          {"system/snappyHexMeshDict", snappyHexMeshDict(patches, cells, inside),
           "the mesh of the inside", ""},
          {"system/controlDict", controlDict(patches), "500 steps, flows through ends", ""},
          {"system/fvSchemes", exportText("openfoam/fvSchemes"), "", ""},
          {"system/fvSolution", exportText("openfoam/fvSolution"), "", ""},
          {"constant/transportProperties",
           exportText("openfoam/transportProperties",
                      {{"viscosity", numberText(blood::kViscosity / blood::kDensity)}}),
           "blood", ""},
          {"constant/turbulenceProperties", exportText("openfoam/turbulenceProperties"), "", ""},
          {"0/U", velocity(patches), "flows at inlets", ""},
          {"0/p", pressure(patches), "pressures at outlets", ""}};
}

std::string cellsRemark(const FoamCells& cells) {
  return "cells of " + numberText(1e-5 * std::round(1e8 * cells.atWall)) + " mm at the wall, " +
         std::to_string(static_cast<int>(cells.acrossThinnest)) + " across the thinnest vessel";
}

}  // namespace

ExportResult exportOpenFoam(const ExportInput& input) {
  ExportedSurface made = lumenSurface(input);
  const SurfaceMesh& mesh = made.mesh;
  const std::vector<Patch> patches = makePatches(mesh, made.ends);
  requireEnds(patches);
  const std::vector<Eigen::Vector3d> inside =
      deepestPoints(input.source.tree, mesh, input.frame, input.progress);
  const auto& radius = input.source.tree.radius;
  const FoamCells cells =
      foamCells(mesh, input.frame.length(*std::min_element(radius.begin(), radius.end())));
  ExportResult result;
  result.start = exportText("openfoam/README.md");
  result.files = dictionaries(patches, cells, inside);
  result.files.push_back({"constant/triSurface/vessel.stl", encodeStl(mesh, true),
                          "the closed surface: solids `wall`, `inlet*`, `outlet*`", ""});
  result.remarks = {cellsRemark(cells)};
  for (const FaceGroup& group : mesh.groups)
    if (group.kind == FaceKind::Cap)
      result.losses.push_back(
          group.name + ": this end is not flat, so it is a wall, and nothing flows through it");
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow openFoamRow() {
  return {.name = "openfoam",
          .title = "OpenFOAM",
          .files = {"Allrun", "system/blockMeshDict", "system/snappyHexMeshDict",
                    "system/controlDict", "constant/triSurface/vessel.stl", "0/U", "0/p"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lps},
          .holds = "the surface with its named ends; a steady flow",
          .lacks = "branches, radii, and that an aneurysm is one",
          .options = {kOption.edge, kOption.maxError, kOption.extend}};
}

}  // namespace lumen::convert
