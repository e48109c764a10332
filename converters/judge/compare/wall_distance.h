// SPDX-License-Identifier: Apache-2.0
// Distance of a case's surface from the true wall.
#pragma once

#include <optional>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/compare/compare.h"

namespace lumen::convert {

struct WallComparison {
  std::optional<Quantiles> all;
  std::vector<std::optional<Quantiles>> branch;  ///< one per true branch
};

/// The distances of Comparison::wallDistance. `found` has models.
WallComparison compareWalls(const formats::Case& found, const formats::CenterlineTree& truth,
                            Progress& progress);

}  // namespace lumen::convert
