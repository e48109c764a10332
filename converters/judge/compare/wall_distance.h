// SPDX-License-Identifier: Apache-2.0
// How far the surface of a case lies from the true wall.
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

/// See Comparison::wallDistance for what is measured. `found` has models.
WallComparison compareWalls(const formats::Case& found, const formats::CenterlineTree& truth,
                            Progress& progress);

}  // namespace lumen::convert
