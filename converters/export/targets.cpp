// SPDX-License-Identifier: Apache-2.0
// The table of targets: all that the command line knows of one is its row.
#include "converters/export/cathsim/export_cathsim.h"
#include "converters/export/mujoco/export_mujoco.h"
#include "converters/export/sofa/export_sofa.h"
#include "converters/export/steve.h"
#include "converters/export/target.h"

namespace lumen::convert {

namespace {

constexpr auto kMm = LengthUnit::Millimetre;
constexpr auto kMetre = LengthUnit::Metre;

// clang-format off
std::vector<ExportTarget> makeTable() {
  return {
      {.name = "cathsim", .title = "CathSim",
       .files = {"phantom_assets/vessel.xml", "phantom_assets/meshes/vessel/visual.stl",
                 "phantom_assets/meshes/vessel/simplified.stl", "phantom_assets/meshes/vessel/hull_0.stl"},
       .units = {kMetre}, .axes = {Axes::Lps},
       .holds = "the surface; the wall as convex pieces; the ends as targets",
       .lacks = "the tree and its radii",
       .options = {"--edge", "--max-error"},
       .write = exportCathsim},
      {.name = "mujoco", .title = "MuJoCo 3",
       .files = {"scene.xml", "scene-joints.xml", "meshes/wall_0.stl"},
       .units = {kMetre}, .axes = {Axes::Lps},
       .holds = "the wall as a solid; a guidewire at the root, pushed by an actuator; the ends",
       .lacks = "the tree and its radii",
       .options = {"--edge", "--max-error", "--insert"},
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
  };
}
// clang-format on

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = makeTable();
  return table;
}

}  // namespace lumen::convert
