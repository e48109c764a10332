// SPDX-License-Identifier: Apache-2.0
// The centerline measures, and which found branch answers for which true one.
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/compare/compare.h"

namespace lumen::convert {

struct CenterlineComparison {
  CenterlineScore all;                  ///< vessels only
  std::vector<CenterlineScore> branch;  ///< one per true branch
};

/// See compare.h for the rules. `step`: mm between samples.
CenterlineComparison compareCenterlines(const formats::CenterlineTree& found,
                                        const formats::CenterlineTree& truth, double step,
                                        Progress& progress);

}  // namespace lumen::convert
