// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/cells.h"

#include "converters/base/number_text.h"
#include "converters/base/text.h"

namespace lumen::convert {

MadeVolumeMesh cellsWithin(const ExportInput& input, const SurfaceMesh& surface, double gap) {
  VolumeMeshOptions options = input.options.volume;
  options.word = input.options.word;
  MadeVolumeMesh made = makeVolumeMesh(input.source, surface, gap, options, input.progress);
  for (Eigen::Vector3d& place : made.mesh.position) place = input.frame.position(place);
  return made;
}

std::string cellsSentence(const VolumeMeshReport& report) {
  return counted(report.prisms, "prism", "prisms") + " at the wall and " +
         counted(report.tetrahedra, "tetrahedron", "tetrahedra") + " within, of a quality of " +
         fixedText(report.leastQuality, 3) + " or more (scaled Jacobian)";
}

}  // namespace lumen::convert
