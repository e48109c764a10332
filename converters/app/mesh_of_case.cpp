// SPDX-License-Identifier: Apache-2.0
#include "converters/app/mesh_of_case.h"

#include <utility>

#include "converters/app/loss_report.h"
#include "converters/surface/polygonise.h"

namespace lumen::app {

std::vector<convert::SurfaceMesh> meshOfCase(const formats::Case& value,
                                             const std::filesystem::path& file,
                                             const OutputOptions& options, int levels,
                                             Progress& progress) {
  std::vector<convert::SurfaceMesh> result;
  convert::PolygoniseOptions patches = options.polygonise;
  patches.cell = convert::cellOf(value, patches);
  for (int level = 0; level < levels; ++level) {
    convert::Patches made = convert::polygonise(value, patches, progress);
    progress.check();
    if (level == 0) reportLosses(made, file.string(), patches.cell, progress);
    result.push_back(std::move(made.surface));
    patches.cell *= 2;
  }
  return result;
}

}  // namespace lumen::app
