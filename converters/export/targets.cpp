// SPDX-License-Identifier: Apache-2.0
// The table of targets: all that the command line knows of one is its row.
#include "converters/export/shared/target.h"
#include "converters/export/targets/cathsim/export_cathsim.h"
#include "converters/export/targets/engines/engines.h"
#include "converters/export/targets/grid/grid.h"
#include "converters/export/targets/isaac/isaac.h"
#include "converters/export/targets/mujoco/export_mujoco.h"
#include "converters/export/targets/oned/oned.h"
#include "converters/export/targets/openfoam/openfoam.h"
#include "converters/export/targets/print/print.h"
#include "converters/export/targets/simvascular/simvascular.h"
#include "converters/export/targets/slicer/slicer.h"
#include "converters/export/targets/sofa/export_sofa.h"
#include "converters/export/targets/steve/steve.h"
#include "converters/export/targets/svzerod/svzerod.h"

namespace lumen::convert {

namespace {

constexpr auto kMm = LengthUnit::Millimetre, kCm = LengthUnit::Centimetre, kM = LengthUnit::Metre;

// clang-format off
std::vector<ExportTarget> makeTable() {
  return {
      {.name = "cathsim", .title = "CathSim",
       .files = {"phantom_assets/vessel.xml", "phantom_assets/meshes/vessel/visual.stl",
                 "phantom_assets/meshes/vessel/simplified.stl", "phantom_assets/meshes/vessel/hull_0.stl"},
       .units = {kM}, .axes = {Axes::Lps},
       .holds = "the surface; the wall as convex pieces; the ends as targets",
       .lacks = "the tree and its radii",
       .options = {"--edge", "--max-error"},
       .write = exportCathsim},
      {.name = "mujoco", .title = "MuJoCo 3",
       .files = {"scene.xml", "scene-joints.xml", "meshes/wall_0.stl"},
       .units = {kM}, .axes = {Axes::Lps},
       .holds = "the wall as a solid; a guidewire at the root, pushed by an actuator; the ends",
       .lacks = "the tree and its radii",
       .options = {"--edge", "--max-error", "--thickness", "--insert"},
       .write = exportMujoco},
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
      {.name = "godot", .title = "Godot 3 and 4", .files = {"vessels.glb"},
       .units = {kM}, .axes = {Axes::Lsa},
       .holds = "the wall as a solid with a collider of its triangles; the ends as nodes",
       .lacks = "the tree, its radii and its models",
       .options = {"--edge", "--max-error", "--thickness"}, .needsVessel = false,
       .write = exportGodot},
      {.name = "unity", .title = "Unity, by a package for glTF", .files = {"vessels.glb"},
       .units = {kM}, .axes = {Axes::Lsa},
       .holds = "the wall as a solid in three levels of detail; the ends as nodes",
       .lacks = "the tree, its radii and its models; a collider, which Unity makes",
       .options = {"--edge", "--max-error", "--thickness"}, .needsVessel = false,
       .write = exportUnity},
      {.name = "unreal", .title = "Unreal Engine 5", .files = {"vessels.glb"},
       .units = {kM, kCm}, .axes = {Axes::Lsa},
       .holds = "the wall as a solid in three levels of detail; the ends as nodes",
       .lacks = "the tree, its radii and its models; a collider, which Unreal makes",
       .options = {"--edge", "--max-error", "--thickness"}, .needsVessel = false,
       .write = exportUnreal},
      {.name = "blender", .title = "Blender", .files = {"vessels.glb"},
       .units = {kM}, .axes = {Axes::Lsa},
       .holds = "the wall as a solid; the ends as empties",
       .lacks = "the tree, its radii and its models",
       .options = {"--edge", "--max-error", "--thickness"}, .needsVessel = false,
       .write = exportBlender},
      {.name = "slicer", .title = "3D Slicer",
       .files = {"scene.mrml", "vessels.vtp", "seeds.mrk.json", "ends.mrk.json"},
       .units = {kMm}, .axes = {Axes::Lps},
       .holds = "the surface; the branches as curves with radii; where they begin; the ends",
       .lacks = "links that close loops, and that an aneurysm is one",
       .options = {"--edge", "--max-error"},
       .write = exportSlicer},
      {.name = "print", .title = "3D printers",
       .files = {"core.3mf", "core.stl"},
       .units = {kMm}, .axes = {Axes::Lps},
       .holds = "the lumen as a solid; a wall around it, with its least thickness",
       .lacks = "the tree, its radii and its models",
       .options = {"--edge", "--max-error", "--thickness"}, .needsVessel = false,
       .write = exportPrint},
      {.name = "grid", .title = "those who read grids of distances",
       .files = {"branches.json"},
       .units = {kMm, kM}, .axes = {Axes::Lps},
       .holds = "the signed distance to the wall, and whose lumen a sample is in",
       .lacks = "what is thinner than two samples; where vessels touch, their walls, but for --per-branch",
       .options = {"--grid", "--format", "--band", "--half", "--per-branch", "--exact"},
       .needsVessel = false, .write = exportGrid},
      {.name = "isaac", .title = "catheter navigation of isaac-for-healthcare, and Isaac Sim",
       .files = {"metadata.json", "mu_volume.npy", "vessel_mask.npy", "centerline_points_mm.npy", "centerline_edges.npy",
                 "centerline_radii_mm.npy", "vessel.usda"},
       .units = {kM, kMm}, .axes = {Axes::Lps, Axes::Lsa},
       .holds = "the tree as arrays; a mask; a synthetic attenuation; a wall with physics schemas of USD, and its ends",
       .lacks = "names of branches, and that an aneurysm is one",
       .options = {"--edge", "--max-error", "--thickness", "--grid"},
       .write = exportIsaac},
  };
}
// clang-format on

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = makeTable();
  return table;
}

}  // namespace lumen::convert
