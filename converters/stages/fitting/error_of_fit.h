// SPDX-License-Identifier: Apache-2.0
// Distances of the fitted surfaces from the points that they were fitted to.
#pragma once

#include <optional>
#include <vector>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

enum class FitDistance {
  /// The one-evaluation distance (docs/method.md, section 4.2) of the node's own model. It equals
  /// Taubin's to first order at the wall, but is bounded: by the node's radius inside, and outside,
  /// where a flat field lets Taubin's grow without limit, by the far side of its ball.
  Wall,
  /// |T - f| / |grad f|, as in Yureidini's thesis; infinity where the field is flat.
  Taubin
};

/// Per node, the error of fit of thesis 4.8.4, mm: the 90th percentile of the distances of the
/// points of the nodes within topological distance `neighbourhood` from the node's surface. NaN for
/// a node whose neighbourhood has no points, infinity for one without blobs. Throws
/// Error(InvalidInput) for a case without points or models, and Error(Cancelled).
std::vector<float> errorOfFit(const formats::Case& value, int neighbourhood, Progress& progress,
                              FitDistance measure = FitDistance::Wall);

/// Over the nodes that have an error of fit; all NaN if none has. Percentiles are nearest-rank.
struct ErrorOfFitSummary {
  double median, p90, max;  ///< mm
};
ErrorOfFitSummary summariseErrorOfFit(std::vector<float> errors);

/// The neighbourhood that the models were fitted over, from the newest "fit" step; 2 if it is not
/// recorded.
int fittedNeighbourhood(const formats::Metadata& metadata);

/// The summary over that neighbourhood; nothing without points, models or a node that has an error.
std::optional<ErrorOfFitSummary> fittedError(const formats::Case& value, Progress& progress);

}  // namespace lumen::convert
