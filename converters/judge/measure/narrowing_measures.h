// SPDX-License-Identifier: Apache-2.0
// Stenoses and dilations against a fitted healthy calibre (docs/measures.md, section 6).
#pragma once

#include <vector>

#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

/// Along a vessel, the values of a robust local line through others: Cleveland, "Robust locally
/// weighted regression and smoothing scatterplots", 1979. `half`: of the window, in the unit of
/// `x`, which ascends.
std::vector<double> robustTrend(const std::vector<double>& x, const std::vector<double>& y,
                                double half);

/// The narrowings and dilations of all vessels, in order.
std::vector<NarrowingMeasures> measureNarrowings(const std::vector<VesselCourse>& courses);

}  // namespace lumen::convert
