// SPDX-License-Identifier: Apache-2.0
// How far the fitted surfaces are from the points that they were fitted to.
#pragma once

#include <vector>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Per node, the error of fit of thesis 4.8.4, mm: the 90th percentile of Taubin's distance
/// |T - f| / |grad f| over the points of the nodes within topological distance `neighbourhood`. NaN
/// for a node whose neighbourhood has no points, infinity where the field is flat. Throws
/// Error(InvalidInput) for a case without points or models, and Error(Cancelled).
std::vector<float> errorOfFit(const formats::Case& value, int neighbourhood, Progress& progress);

/// Over the nodes that have an error of fit; all NaN if none has. Percentiles are nearest-rank.
struct ErrorOfFitSummary {
  double median, p90, max;  ///< mm
};
ErrorOfFitSummary summariseErrorOfFit(std::vector<float> errors);

}  // namespace lumen::convert
