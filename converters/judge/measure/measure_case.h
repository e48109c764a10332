// SPDX-License-Identifier: Apache-2.0
// All measures of a case.
#pragma once

#include <optional>

#include "converters/base/progress.h"
#include "converters/judge/measure/measures.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct MeasureOptions {
  /// mm between stations along a vessel; nothing: half of its median radius, rounded so that it
  /// divides the vessel's length. No other measure depends on it.
  std::optional<double> step;
};

/// Measures a valid case. Without models radii are those of the tree and sections are left out.
/// Throws Error(Failed) if libblob refuses the models, and Error(Cancelled).
CaseMeasures measureCase(const formats::Case& source, const MeasureOptions& options,
                         Progress& progress);

}  // namespace lumen::convert
