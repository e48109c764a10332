// SPDX-License-Identifier: Apache-2.0
// What a record states of its case beside what the case gives.
#pragma once

#include <string>

#include "converters/library/library_fault.h"
#include "converters/library/record.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Bounds, figures, insertions and ends that are not those of the case, to a thousandth of a
/// millimetre, which is finer than anything in a volume and coarser than what rounding does. `path`
/// is the record's.
void checkFigures(const formats::Case& value, const CaseRecord& record, const std::string& path,
                  FaultList& faults);

}  // namespace lumen::convert
