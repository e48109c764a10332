// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/openfoam.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/blood.h"
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

std::string exact(double value) {
  return numberText(value, 12);
}

std::string vectorText(const Eigen::Vector3d& v) {
  return "(" + exact(v.x()) + " " + exact(v.y()) + " " + exact(v.z()) + ")";
}

std::string header(const std::string& type, const std::string& name) {
  return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + type + ";\n    object " +
         name + ";\n}\n\n";
}

std::vector<Patch> patchesOf(const SurfaceMesh& mesh, const std::vector<NamedEnd>& ends) {
  const std::vector<std::string> names = distinct(namesOf(mesh.groups), openFoamWord);
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

/// `text` for each patch of a kind, with % for its name.
std::string forEach(const std::vector<Patch>& patches, FaceKind kind, const std::string& text) {
  std::string all;
  for (const Patch& patch : patches) {
    if (patch.kind != kind) continue;
    std::string one = text;
    for (std::size_t at = 0; (at = one.find('%', at)) != std::string::npos; at += patch.name.size())
      one.replace(at, 1, patch.name);
    all += one;
  }
  return all;
}

std::string blockMeshDict(const FoamCells& cells) {
  std::string text = header("dictionary", "blockMeshDict") + "convertToMeters 1;\n\nvertices\n(\n";
  const Eigen::Vector3d size(cells.count[0], cells.count[1], cells.count[2]);
  for (const auto& corner : std::initializer_list<Eigen::Vector3d>{
           {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
    text += "    " + vectorText(cells.low + cells.edge() * size.cwiseProduct(corner)) + "\n";
  text += ");\n\nblocks\n(\n    hex (0 1 2 3 4 5 6 7) (";
  for (const int n : cells.count) text += (text.back() == '(' ? "" : " ") + std::to_string(n);
  return text +
         ") simpleGrading (1 1 1)\n);\n\nedges ();\n\nboundary\n(\n    box\n    {\n        type "
         "patch;\n"
         "        faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7));\n    "
         "}\n);\n\n"
         "mergePatchPairs ();\n";
}

// minVol: the usual 1e-13 m^3 is a cell of 0.05 mm
const char* const kSnapping = R"(
snapControls
{
    nSmoothPatch 3;
    tolerance 2.0;
    nSolveIter 50;
    nRelaxIter 8;
    nFeatureSnapIter 10;
    implicitFeatureSnap false;
    explicitFeatureSnap true;
    multiRegionFeatureSnap true;
}

addLayersControls
{
    relativeSizes true;
    layers {}
    expansionRatio 1.2;
    finalLayerThickness 0.5;
    minThickness 0.1;
    nGrow 0;
    featureAngle 60;
    nRelaxIter 5;
    nSmoothSurfaceNormals 1;
    nSmoothNormals 3;
    nSmoothThickness 10;
    maxFaceThicknessRatio 0.5;
    maxThicknessToMedialRatio 0.3;
    minMedianAxisAngle 90;
    nBufferCellsNoExtrude 0;
    nLayerIter 50;
}

meshQualityControls
{
    maxNonOrtho 65;
    maxBoundarySkewness 20;
    maxInternalSkewness 4;
    maxConcave 80;
    minVol 1e-20;
    minTetQuality 1e-15;
    minArea -1;
    minTwist 0.02;
    minDeterminant 0.001;
    minFaceWeight 0.05;
    minVolRatio 0.01;
    minTriangleTwist -1;
    nSmoothScale 4;
    errorReduction 0.75;
    relaxed { maxNonOrtho 70; }
}

mergeTolerance 1e-6;
)";

/// How often cells are halved at a patch: at an end so often that six lie across, or the end of a thin vessel were lost.
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
  const std::string level = std::to_string(cells.level), both = "(" + level + " " + level + ")";
  std::string regions, refined, places;
  for (const Patch& patch : patches) {
    regions += "            " + patch.name + " { name " + patch.name + "; }\n";
    refined += refinement(patch, cells);
  }
  for (const Eigen::Vector3d& p : inside) places += " (" + vectorText(p) + " none)";
  return header("dictionary", "snappyHexMeshDict") +
         "castellatedMesh true;\nsnap true;\naddLayers false;\n\ngeometry\n{\n    vessel.stl\n    "
         "{\n"
         "        type triSurfaceMesh;\n        name vessel;\n        regions\n        {\n" +
         regions +
         "        }\n    }\n}\n\ncastellatedMeshControls\n{\n    maxLocalCells 5000000;\n"
         "    maxGlobalCells 5000000;\n    minRefinementCells 0;\n    maxLoadUnbalance 0.1;\n"
         "    nCellsBetweenLevels 3;\n    features ( { file \"vessel.eMesh\"; level " +
         level +
         "; } );\n    refinementSurfaces\n    {\n        vessel\n        {\n            level " +
         both + ";\n            regions\n            {\n" + refined +
         "            }\n        }\n    }\n    resolveFeatureAngle 30;\n    refinementRegions "
         "{}\n" +
         (inside.size() == 1 ? "    locationInMesh " + vectorText(inside.front())
                             : "    locationsInMesh (" + places + " )") +
         ";\n    allowFreeStandingZoneFaces false;\n}\n" + kSnapping;
}

std::string controlDict(const std::vector<Patch>& patches) {
  const std::string flow =
      "    flow_%\n    {\n        type surfaceFieldValue;\n        libs (fieldFunctionObjects);\n"
      "        fields (phi);\n        operation sum;\n        regionType patch;\n        name %;\n"
      "        writeFields false;\n        writeControl timeStep;\n        log false;\n    }\n";
  return header("dictionary", "controlDict") +
         "application simpleFoam;\nstartFrom latestTime;\nstartTime 0;\nstopAt endTime;\nendTime "
         "500;\n"
         "deltaT 1;\nwriteControl timeStep;\nwriteInterval 500;\npurgeWrite 0;\nwriteFormat "
         "ascii;\n"
         "writePrecision 8;\nwriteCompression off;\ntimeFormat general;\ntimePrecision 6;\n"
         "runTimeModifiable false;\n\n// m^3/s through each end, out of the vessels, in "
         "postProcessing\n"
         "functions\n{\n" +
         forEach(patches, FaceKind::Inlet, flow) + forEach(patches, FaceKind::Outlet, flow) + "}\n";
}

const char* const kSchemes = R"(ddtSchemes { default steadyState; }
gradSchemes { default cellLimited Gauss linear 1; }
divSchemes
{
    default none;
    div(phi,U) bounded Gauss linearUpwind grad(U);
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear limited 0.5; }
interpolationSchemes { default linear; }
snGradSchemes { default limited 0.5; }
)";

const char* const kSolution = R"(solvers
{
    p { solver GAMG; smoother GaussSeidel; tolerance 1e-10; relTol 0.05; }
    U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; }
}

SIMPLE
{
    nNonOrthogonalCorrectors 1;
    consistent yes;
    residualControl { p 1e-5; U 1e-6; }
}

relaxationFactors { equations { U 0.8; } }
)";

const char* const kFeatures = R"(vessel.stl
{
    extractionMethod extractFromSurface;
    extractFromSurfaceCoeffs { includedAngle 150; }
    writeObj no;
}
)";

const char* const kAllrun = R"sh(#!/bin/sh
# The mesh, its check, and the flow. On Debian the programs only need to be told where OpenFOAM's settings are.
set -e
cd "$(dirname "$0")"
[ -n "$WM_PROJECT_DIR" ] || export WM_PROJECT_DIR=/usr/share/openfoam
run() { echo "$1"; "$@" > "log.$1" 2>&1 || { echo "$1 failed: see log.$1" >&2; exit 1; }; }
run surfaceCheck constant/triSurface/vessel.stl
run surfaceFeatureExtract
run blockMesh
run snappyHexMesh -overwrite
run checkMesh
run simpleFoam
)sh";

std::string velocity(const std::vector<Patch>& patches) {
  std::string text =
      header("volVectorField", "U") +
      "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 0);\n\nboundaryField\n{\n" +
      forEach(patches, FaceKind::Wall, "    % { type noSlip; }\n");
  for (const Patch& patch : patches)
    if (patch.kind == FaceKind::Inlet)
      text += "    " + patch.name + " { type flowRateInletVelocity; volumetricFlowRate constant " +
              exact(blood::meanFlow(patch.radius)) + "; value uniform (0 0 0); }\n";
  return text +
         forEach(
             patches, FaceKind::Outlet,
             "    % { type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0); }\n") +
         "}\n";
}

std::string pressure(const std::vector<Patch>& patches) {
  return header("volScalarField", "p") +
         "// of the density, m^2/s^2\ndimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\n\n"
         "boundaryField\n{\n" +
         forEach(patches, FaceKind::Wall, "    % { type zeroGradient; }\n") +
         forEach(patches, FaceKind::Inlet, "    % { type zeroGradient; }\n") +
         forEach(patches, FaceKind::Outlet, "    % { type fixedValue; value uniform 0; }\n") +
         "}\n";
}

const char* const kStart =
    "    sh Allrun\n\nmakes the mesh and runs `simpleFoam`, steady and laminar, in OpenFOAM v1912 "
    "(Debian 12) or later; it "
    "leaves `log.*`,\nflows through each end in `postProcessing`, and fields that `foamToVTK` and "
    "ParaView read.\n\n"
    "| stated | | source |\n|---|---|---|\n"
    "| blood | kinematic viscosity 3.774e-6 m^2/s: 4 mPa s, 1060 kg/m^3, Newtonian | defaults of "
    "SimVascular's solvers |\n"
    "| inlets | a steady 0.2 m/s times the area, over the section | in the range of arteries; put "
    "your own flow into `0/U` |\n"
    "| outlets | pressure 0 | flow splits by what vessels resist; `lumen export svzerod` has "
    "resistances |\n"
    "| wall | rigid | |\n\n"
    "Pressures are divided by the density: times 1060 they are Pa.\n";

std::vector<ExportFile> dictionaries(const std::vector<Patch>& patches, const FoamCells& cells,
                                     const std::vector<Eigen::Vector3d>& inside) {
  return {
      {"Allrun", kAllrun, "makes the mesh and runs the flow", ""},
      {"system/blockMeshDict", blockMeshDict(cells), "cubes around the vessels", ""},
      {"system/surfaceFeatureExtractDict",
       header("dictionary", "surfaceFeatureExtractDict") + kFeatures, "the rims of flat ends", ""},
      {"system/snappyHexMeshDict", snappyHexMeshDict(patches, cells, inside),
       "the mesh of the inside", ""},
      {"system/controlDict", controlDict(patches), "500 steps, flows through ends", ""},
      {"system/fvSchemes", header("dictionary", "fvSchemes") + kSchemes, "", ""},
      {"system/fvSolution", header("dictionary", "fvSolution") + kSolution, "", ""},
      {"constant/transportProperties",
       header("dictionary", "transportProperties") +
           "transportModel Newtonian;\nnu [0 2 -1 0 0 0 0] " +
           numberText(blood::kViscosity / blood::kDensity) + ";\n",
       "blood", ""},
      {"constant/turbulenceProperties",
       header("dictionary", "turbulenceProperties") + "simulationType laminar;\n", "", ""},
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
  const std::vector<Patch> patches = patchesOf(mesh, made.ends);
  requireEnds(patches);
  const std::vector<Eigen::Vector3d> inside =
      deepestPoints(input.source.tree, mesh, input.frame, input.progress);
  const auto& radius = input.source.tree.radius;
  const FoamCells cells =
      foamCells(mesh, input.frame.length(*std::min_element(radius.begin(), radius.end())));
  ExportResult result;
  result.start = kStart;
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

}  // namespace lumen::convert
