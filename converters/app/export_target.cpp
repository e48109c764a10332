// SPDX-License-Identifier: Apache-2.0
#include "converters/app/export_target.h"

#include <utility>

#include "converters/app/loss_report.h"
#include "converters/app/suggestion.h"
#include "converters/app/surface_report.h"
#include "converters/common/error.h"
#include "converters/sofa/export_sofa.h"
#include "converters/steve/export_steve.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

/// Warns of vessels that a grid passes over: those with less than two samples across.
void warnOfGrid(double spacing, const formats::Case& value, const std::string& folder,
                Progress& progress) {
  std::size_t lost = 0;
  for (const float radius : value.tree.radius) lost += radius < spacing ? 1 : 0;
  if (spacing > 0 && lost > 0)
    progress.warn(formats::printable(folder) + ": the grid's samples are " + fixed(spacing, 2) +
                  " mm apart, too wide for the vessels at " + counted(lost, "node", "nodes") +
                  " of " + std::to_string(value.tree.nodeCount()) +
                  "; --grid takes a smaller distance");
}

ExportResult writeSofa(const formats::Case& value, const std::string& folder,
                       const ExportOptions& options, Progress& progress) {
  convert::SofaExport made = convert::exportSofa(value, options.sofa, options.surface, progress);
  warnOfSurface(made.surface, folder, progress);
  warnOfGrid(made.gridSpacing, value, folder, progress);
  const convert::Insertion& in = made.insertion;
  const std::string label = formats::printable(value.tree.branches[in.branch].label);
  ExportResult result{std::move(made.files), std::move(made.surface), {}};
  result.remarks.push_back("inserted in " + label + " at (" + fixed(in.position.x(), 1) + ", " +
                           fixed(in.position.y(), 1) + ", " + fixed(in.position.z(), 1) + ") mm, " +
                           std::to_string(made.steps) + " steps");
  return result;
}

ExportResult writeSteve(const formats::Case& value, const std::string& folder,
                        const ExportOptions& options, Progress& progress) {
  reportTreeLosses(value, folder, progress);
  convert::SteveExport made = convert::exportSteve(value, options.surface, progress);
  warnOfSurface(made.surface, folder, progress);
  return {std::move(made.files), std::move(made.surface), {}};
}

// clang-format off
std::vector<ExportTarget> makeTable() {
  return {
      {.name = "sofa", .title = "SOFA with BeamAdapter",
       .files = {"scene.scn", "scene.py", "vessel.obj", "case.lumen", "README.md"},
       .unit = "mm", .frame = "LPS",
       .holds = "the case; the surface; an instrument at the root, with friction contact",
       .lacks = "nothing: the case lies beside the scene",
       .options = {"--instrument", "--wall", "--dialect", "--step", "--insert", "--grid"},
       .write = writeSofa},
      {.name = "steve", .title = "stEVE",
       .files = {"vessels.py", "vessel.obj", "Meshes/vessel.vtp", "README.md"},
       .unit = "mm; cm in Paths and Meshes", .frame = "LPS",
       .holds = "the branches with their radii; the surface; the root as the insertion",
       .lacks = "links that close loops, and that an aneurysm is one",
       .options = {},
       .write = writeSteve},
  };
}
// clang-format on

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = makeTable();
  return table;
}

const ExportTarget& exportTarget(std::string_view name) {
  std::vector<std::string> names;
  for (const ExportTarget& target : exportTargets()) {
    if (target.name == name) return target;
    names.emplace_back(target.name);
  }
  throw unsupported(formats::printable(std::string(name)) +
                    ": lumen does not export to this; it exports to " + alternatives(names) +
                    didYouMean(name, names));
}

}  // namespace lumen::app
