// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/levels_of_detail.h"

#include <utility>

namespace lumen::convert {

std::vector<DetailLevel> levelsOfDetail(CaseSurface surface, const SheetField& field,
                                        std::size_t count, Progress& progress) {
  std::vector<DetailLevel> levels;
  while (levels.size() < count) {
    SurfaceError error;
    if (levels.empty()) {
      error = surfaceError(surface, field);
    } else {
      const DecimateOptions quarter{0, surface.mesh.triangle.size() / 4};
      error = decimate(surface, field, quarter, progress);
    }
    levels.push_back({surface, error});
  }
  return levels;
}

}  // namespace lumen::convert
