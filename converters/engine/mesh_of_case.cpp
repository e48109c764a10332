// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_of_case.h"

#include <utility>

#include "converters/engine/answers/case_losses.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/stages/surface/patches/polygonise.h"

namespace lumen::engine {

namespace {

CaseMesh patchesOfCase(const formats::Case& value, const std::filesystem::path& file,
                       const OutputOptions& options, int levels, Progress& progress) {
  CaseMesh result;
  convert::PolygoniseOptions patches = options.polygonise;
  patches.cell = convert::chooseCell(value, patches);
  for (int level = 0; level < levels; ++level) {
    convert::Patches made = convert::polygonise(value, patches, progress);
    progress.check();
    if (level == 0) reportLosses(made, file.string(), patches.cell, progress);
    result.levels.push_back(std::move(made.surface));
    patches.cell *= 2;
  }
  return result;
}

}  // namespace

CaseMesh meshOfCase(const formats::Case& value, const std::filesystem::path& file,
                    const OutputOptions& options, bool hasLevels, Progress& progress) {
  convert::ClosedSurfaceOptions surface = options.surface;
  if (!hasLevels) surface.levels = 1;
  if (options.patches) return patchesOfCase(value, file, options, surface.levels, progress);
  convert::ClosedSurface made = convert::closedSurface(value, surface, progress);
  warnOfSurface(made.report, file.string(), progress);
  return {std::move(made.levels), std::move(made.report)};
}

}  // namespace lumen::engine
