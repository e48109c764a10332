// SPDX-License-Identifier: Apache-2.0
// The table of targets: all that the command line knows of one is its row.
#include "converters/export/oned.h"
#include "converters/export/openfoam.h"
#include "converters/export/simvascular.h"
#include "converters/export/sofa/export_sofa.h"
#include "converters/export/steve.h"
#include "converters/export/svzerod.h"
#include "converters/export/target.h"

namespace lumen::convert {

namespace {

constexpr auto kMm = LengthUnit::Millimetre, kCm = LengthUnit::Centimetre, kM = LengthUnit::Metre;

// clang-format off
std::vector<ExportTarget> makeTable() {
  return {
      {.name = "sofa", .title = "SOFA with BeamAdapter",
       .files = {"scene.scn", "scene.py", "vessel.obj", "case.lumen"},
       .units = {kMm}, .axes = {Axes::Lps},
       .holds = "the case; the surface; an instrument at the root, with friction contact",
       .lacks = "nothing: the case lies beside the scene",
       .options = {"--edge", "--max-error", "--instrument", "--wall", "--dialect", "--step", "--insert", "--grid"},
       .write = exportSofa},
      {.name = "steve", .title = "stEVE",
       .files = {"vessels.py", "vessel.obj", "Meshes/vessel.vtp"},
       .units = {kMm}, .axes = {Axes::Lps},
       .holds = "the branches with their radii; the surface; the root as the insertion",
       .lacks = "links that close loops, and that an aneurysm is one",
       .options = {"--edge", "--max-error"},
       .write = exportSteve},
      {.name = "svzerod", .title = "svZeroDSolver",
       .files = {"model.json"},
       .units = {kCm}, .axes = {Axes::Lps},
       .holds = "lengths, radii, junctions and loops, as resistance, compliance and inertance of each segment",
       .lacks = "aneurysms; the shape of sections",
       .options = {},
       .needsModels = false,
       .write = exportSvZeroD},
      {.name = "oned", .title = "svOneDSolver and openBF",
       .files = {"vessels.in", "vessels.yml", "vessels_inlet.dat"},
       .units = {kCm}, .axes = {Axes::Lps},
       .holds = "lengths, radii, junctions; svOneDSolver also positions of junctions",
       .lacks = "aneurysms; the shape of sections; of vessels all but a cone",
       .options = {},
       .needsModels = false,
       .write = exportOneD},
      {.name = "openfoam", .title = "OpenFOAM",
       .files = {"Allrun", "system/blockMeshDict", "system/snappyHexMeshDict", "system/controlDict",
                 "constant/triSurface/vessel.stl", "0/U", "0/p"},
       .units = {kM}, .axes = {Axes::Lps},
       .holds = "the surface with its named ends; a steady flow",
       .lacks = "branches, radii, and that an aneurysm is one",
       .options = {"--edge", "--max-error", "--extend"},
       .write = exportOpenFoam},
      {.name = "simvascular", .title = "SimVascular",
       .files = {"vessels.svproj", "Models/vessel.mdl", "Models/vessel.vtp"},
       .units = {kCm}, .axes = {Axes::Lps},
       .holds = "branches as paths, radii as circles; the surface with its named ends; a volume mesh, by TetGen if it is installed",
       .lacks = "links that close loops, and that an aneurysm is one",
       .options = {"--edge", "--max-error", "--extend"},
       .write = exportSimVascular},
  };
}
// clang-format on

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = makeTable();
  return table;
}

}  // namespace lumen::convert
