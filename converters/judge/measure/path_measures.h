// SPDX-License-Identifier: Apache-2.0
// Paths from an inlet to each end of its tree (docs/measures.md, section 4).
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

/// One path for each end of a vessel where no other goes on, in the order of the branches. `shared`:
/// standard deviation that all radii share, mm.
std::vector<PathMeasures> measurePaths(const formats::CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses,
                                       const std::vector<ForkMeasures>& forks, double shared,
                                       const Progress& progress);

}  // namespace lumen::convert
