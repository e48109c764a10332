// SPDX-License-Identifier: Apache-2.0
// Alternative that a user would begin with: vesselness at several scales.
#pragma once

#include "converters/voxels/volume.h"

namespace lumen::bench {

struct Vesselness {
  double seconds = 0;  ///< of the filter alone
  double mean = 0;     ///< of its output, so that the work cannot be dropped
};

/// ITK's MultiScaleHessianBasedMeasureImageFilter with tubular objectness (Frangi et al., 1998), 5
/// scales spaced logarithmically from the least to the greatest sigma, mm, on so many threads.
Vesselness multiScaleVesselness(const convert::Volume& volume, double least, double greatest,
                                int threads);

}  // namespace lumen::bench
