// SPDX-License-Identifier: Apache-2.0
// Angles and calibres of forks (docs/measures.md, section 5).
#pragma once

#include <vector>

#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

/// One row for each pair of vessels that leave a fork, in the order of the forks' nodes.
std::vector<ForkMeasures> measureForks(const formats::CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses);

}  // namespace lumen::convert
