// SPDX-License-Identifier: Apache-2.0
// Facts of a case's record that follow from the case itself.
#pragma once

#include <string>

#include "converters/base/progress.h"
#include "converters/library/index/record.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Sets bounds, figures, insertions, ends and provenance of `record`, whose other members stay. The
/// case is valid and has a node; `caseSha256` is of its file. Numbers have the precision of a
/// float, in the shortest decimals. Equal cases give equal records. Throws Error(InvalidInput) for
/// a case without nodes, Error(Cancelled).
void describe(const formats::Case& source, const std::string& caseSha256, CaseRecord& record,
              Progress& progress);

}  // namespace lumen::convert
