// SPDX-License-Identifier: Apache-2.0
#include "converters/app/export_target.h"

#include <utility>

#include "converters/app/suggestion.h"
#include "converters/app/surface_report.h"
#include "converters/common/error.h"
#include "converters/sofa/export_sofa.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

ExportResult writeSofa(const formats::Case& value, const std::string& folder,
                       const ExportOptions& options, Progress& progress) {
  convert::SofaExport made = convert::exportSofa(value, options.sofa, options.surface, progress);
  warnOfSurface(made.surface, folder, progress);
  const convert::Insertion& in = made.insertion;
  const std::string label = formats::printable(value.tree.branches[in.branch].label);
  ExportResult result{std::move(made.files), std::move(made.surface), {}};
  result.remarks.push_back("inserted in " + label + " at (" + fixed(in.position.x(), 1) + ", " +
                           fixed(in.position.y(), 1) + ", " + fixed(in.position.z(), 1) + ") mm, " +
                           std::to_string(made.steps) + " steps");
  return result;
}

// clang-format off
std::vector<ExportTarget> makeTable() {
  return {
      {.name = "sofa", .title = "SOFA with BeamAdapter",
       .files = {"scene.scn", "scene.py", "vessel.obj", "case.lumen", "README.md"},
       .unit = "mm", .frame = "LPS",
       .holds = "the case; the surface; an instrument at the root, with friction contact",
       .lacks = "nothing: the case lies beside the scene",
       .options = {"--instrument", "--wall", "--dialect", "--step", "--insert"},
       .write = writeSofa},
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
