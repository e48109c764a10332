// SPDX-License-Identifier: Apache-2.0
// All measures of a case.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/progress.h"
#include "converters/judge/measure/measure_tables.h"
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

// Tables of measures as JSON and as comma-separated values.

/// Tables of one case.
struct MeasuredCase {
  std::string name;  ///< of the case, as tables of many cases state it
  std::vector<MeasureTable> tables;
};

/// The tables as a member for each kind, each an array of its rows (measure.schema.json). A value
/// is an object of its number, its half interval and the reason why it is not defined; numbers have
/// six significant digits.
nlohmann::ordered_json measuresJson(std::span<const MeasureTable> tables);

/// All measures of a valid case as measuresJson() has them. Throws as measureCase().
nlohmann::ordered_json measuresJson(const formats::Case& source, const MeasureOptions& options,
                                    Progress& progress);

/// The tables of one kind of all cases as one text (RFC 4180): a column `case`, those of text,
/// three for each place, two for each value (the second is its half interval, `_pm`), and `absent`,
/// which states why values are empty; behind the texts `system`, if a case states systems.
std::string measuresCsv(std::span<const MeasuredCase> cases, std::size_t kind);

/// All tables of all cases as one text with a row for each value: case, kind, the row's texts, its
/// place, the measure with its unit, the value, its half interval, and why it is empty.
std::string measuresLongCsv(std::span<const MeasuredCase> cases);

}  // namespace lumen::convert
