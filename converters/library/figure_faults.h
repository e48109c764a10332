// SPDX-License-Identifier: Apache-2.0
// Comparison of the figures in a record with those of its case.
#pragma once

#include <string>

#include "converters/library/library_fault.h"
#include "converters/library/record.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Adds faults for bounds, figures, insertions and ends that are not those of the case, to a
/// thousandth of a millimetre, which is finer than anything in a volume and coarser than rounding.
/// `path` is the record's.
void checkFigures(const formats::Case& value, const CaseRecord& record, const std::string& path,
                  FaultList& faults);

}  // namespace lumen::convert
