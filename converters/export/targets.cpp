// SPDX-License-Identifier: Apache-2.0
// The table of targets: the row that each states, and its function with the options that it takes.
#include "converters/export/targets/targets.h"

#include "converters/export/export_case.h"
#include "converters/export/targets/grid/grid.h"
#include "converters/export/targets/openfoam/openfoam.h"
#include "converters/export/targets/sofa/export_sofa.h"

namespace lumen::convert {

namespace {

/// The writer of a target without options of its own.
template <ExportResult (*kWrite)(const ExportInput&)>
ExportResult common(const ExportInput& input, const ExportOptions& /*options*/) {
  return kWrite(input);
}

ExportResult sofa(const ExportInput& input, const ExportOptions& options) {
  return exportSofa(input, options.sofa);
}

ExportResult openFoam(const ExportInput& input, const ExportOptions& options) {
  return exportOpenFoam(input, options.foam);
}

ExportResult grid(const ExportInput& input, const ExportOptions& options) {
  return exportGrid(input, options.grid);
}

}  // namespace

const std::vector<ExportTarget>& exportTargets() {
  static const std::vector<ExportTarget> table = {
      {cathsimRow(), common<exportCathsim>},
      {mujocoRow(), common<exportMujoco>},
      {sofaRow(), sofa},
      {steveRow(), common<exportSteve>},
      {svZeroDRow(), common<exportSvZeroD>},
      {oneDRow(), common<exportOneD>},
      {openFoamRow(), openFoam},
      {simVascularRow(), common<exportSimVascular>},
      {godotRow(), common<exportGodot>},
      {unityRow(), common<exportUnity>},
      {unrealRow(), common<exportUnreal>},
      {blenderRow(), common<exportBlender>},
      {slicerRow(), common<exportSlicer>},
      {printRow(), common<exportPrint>},
      {gridRow(), grid},
      {isaacRow(), common<exportIsaac>},
  };
  return table;
}

}  // namespace lumen::convert
