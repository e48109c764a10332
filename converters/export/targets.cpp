// SPDX-License-Identifier: Apache-2.0
// The table of targets: all that the command line knows of one is its row.
#include "converters/export/grid.h"
#include "converters/export/isaac.h"
#include "converters/export/sofa/export_sofa.h"
#include "converters/export/steve.h"
#include "converters/export/target.h"

namespace lumen::convert {

namespace {

constexpr auto kMm = LengthUnit::Millimetre;

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
      {.name = "grid", .title = "those who read grids of distances",
       .files = {"branches.json"},
       .units = {kMm, LengthUnit::Metre}, .axes = {Axes::Lps},
       .holds = "the signed distance to the wall, and whose lumen a sample is in",
       .lacks = "what is thinner than two samples; where vessels touch, their walls, but for --per-branch",
       .options = {"--grid", "--format", "--band", "--half", "--per-branch", "--exact"},
       .needsVessel = false, .write = exportGrid},
      {.name = "isaac", .title = "catheter navigation of isaac-for-healthcare, and Isaac Sim",
       .files = {"metadata.json", "mu_volume.npy", "vessel_mask.npy", "centerline_points_mm.npy", "centerline_edges.npy",
                 "centerline_radii_mm.npy", "vessel.usda"},
       .units = {LengthUnit::Metre, kMm}, .axes = {Axes::Lps, Axes::Lsa},
       .holds = "the tree as arrays; a mask; a synthetic attenuation; a wall with physics schemas of USD, and its ends",
       .lacks = "names of branches, and that an aneurysm is one",
       .options = {"--edge", "--max-error", "--grid"},
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
