// SPDX-License-Identifier: Apache-2.0
// Answer of `lumen measure`.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/operations/measures_of.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// spec/answers/measure.schema.json, without files. In the tables of a case those of its changes
/// follow those of its measures. `against`: the file of the earlier case; empty without one.
Json measureJson(const std::vector<convert::MeasuredCase>& cases, const std::string& against);

/// The numbers of rows, and columns with the vessels and aneurysms of the case in `file`.
std::string measureText(const std::string& file, const formats::Case& source,
                        const operations::CaseMeasures& measures);

/// The numbers of changes against the case in the file `against`.
std::string changesText(const std::string& against,
                        const std::vector<convert::MeasureTable>& changes);

}  // namespace lumen::engine
