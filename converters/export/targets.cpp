// SPDX-License-Identifier: Apache-2.0
// The table of targets: all that the command line knows of one is its row.
#include "converters/export/cathsim/export_cathsim.h"
#include "converters/export/engines.h"
#include "converters/export/mujoco/export_mujoco.h"
#include "converters/export/print.h"
#include "converters/export/slicer.h"
#include "converters/export/sofa/export_sofa.h"
#include "converters/export/steve.h"
#include "converters/export/target.h"

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
  };
}
// clang-format on

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = makeTable();
  return table;
}

}  // namespace lumen::convert
