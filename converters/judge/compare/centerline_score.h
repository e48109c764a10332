// SPDX-License-Identifier: Apache-2.0
// Centerline measures, and the assignment of found branches to true ones.
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/compare/compare.h"

namespace lumen::convert {

struct CenterlineComparison {
  CenterlineScore all;                  ///< vessels only
  std::vector<CenterlineScore> branch;  ///< one per true branch
};

/// The scores by the rules of compare.h. `step`: mm between samples.
CenterlineComparison compareCenterlines(const formats::CenterlineTree& found,
                                        const formats::CenterlineTree& truth, double step,
                                        Progress& progress);

}  // namespace lumen::convert
