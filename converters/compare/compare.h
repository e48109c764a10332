// SPDX-License-Identifier: Apache-2.0
// A case against the truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct Quantiles {
  double median = 0, p90 = 0, max = 0;
};

/// Schaap et al., "Standardized evaluation methodology and reference database for evaluating coronary
/// artery centerline extraction algorithms" (2009): OV, OF, AI. Lengths in mm.
struct CenterlineScore {
  double overlap = 0;                 ///< OV, in [0, 1]
  double overlapUntilFirstError = 0;  ///< OF, in [0, 1]
  double averageInside = 0;           ///< AI, mm; NaN if nothing overlaps
  double assd = 0;                    ///< average symmetric surface distance of the centerlines, mm
  double assdLimited = 0;             ///< the same over distances below the mean radius (thesis eq. 3.9, 3.10), mm
  double radiusBias = 0;              ///< mean of found minus true radius over matched points, mm
  double radiusRms = 0;               ///< mm
  double missed = 0;                  ///< true length that nothing found, mm
  double falseLength = 0;             ///< found length that is not there, mm
};

struct BranchComparison {
  std::string label;
  CenterlineScore score;
  std::optional<Quantiles> wallDistance;  ///< absent if the case has no models
};

struct Comparison {
  CenterlineScore score;
  std::optional<Quantiles> wallDistance;  ///< of the models' surface to the true one, mm, away from branch ends
  std::vector<BranchComparison> branches;  ///< one per true branch
};

Comparison compareCases(const formats::Case& found, const formats::Case& truth, Progress& progress);

}  // namespace lumen::convert
