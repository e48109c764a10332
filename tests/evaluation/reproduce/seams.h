// SPDX-License-Identifier: Apache-2.0
// How far the surfaces of adjacent models are apart where one takes over from the other.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::reproduce {

/// A seam is the part of the radical plane of a node and its parent that both cells share: where no
/// other node within two edges of either has a smaller power. The surface of each of the two models
/// is sampled on it along rays in the plane, from the point where the plane meets the line between
/// the centres; the jump is the distance, mm, from the sample to the other model's surface.
struct SeamJumps {
  std::vector<double> jump;  ///< ascending
  std::size_t seams = 0;     ///< pairs of a node and its parent that have samples
  std::size_t lost = 0;      ///< samples from which the other surface was not found
  std::size_t open = 0;      ///< rays that left no model within 4 radii, or started outside it
};

/// The case must have models. Throws Error(Cancelled).
SeamJumps measureSeams(const formats::Case& value, Progress& progress);

/// The smallest value that at least `share` of the ascending values do not exceed; NaN of none.
double quantile(const std::vector<double>& ascending, double share);

}  // namespace lumen::reproduce
