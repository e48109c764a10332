// SPDX-License-Identifier: Apache-2.0
// The measures of a case.
#pragma once

#include <vector>

#include "converters/judge/measure/measure_case.h"
#include "converters/operations/context.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct CaseMeasures {
  convert::CaseMeasures values;               ///< lengths in mm, with uncertainties
  std::vector<convert::MeasureTable> tables;  ///< the same, one table for each kind
};

/// The measures of a valid case. Without models radii are those of the tree, and measures of
/// cross-sections state why they are absent. Those of two cases in one frame give their differences
/// by convert::measureChanges(). Takes seconds, on all threads. Throws Error(Failed) if libblob
/// refuses the models, and Error(Cancelled).
CaseMeasures measuresOf(const formats::Case& value, const convert::MeasureOptions& options,
                        const Context& context);

}  // namespace lumen::operations
