// SPDX-License-Identifier: Apache-2.0
// The measures of a case as tables, one for each kind: the form that files, pages and answers share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "converters/judge/measure/measures.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// One row: a vessel, a fork, a place. Its texts, places and values are in the order of the
/// table's columns.
struct MeasureRow {
  std::vector<std::string> labels;
  std::vector<Place> places;  ///< mm, LPS; not finite where there is none
  std::vector<Measured> values;
};

/// All measures of one kind. Every row has a place of its own first, "place"; the place of a value
/// that lies elsewhere has the name of the value without its unit, as "smallest_radius".
struct MeasureTable {
  std::string_view kind;                 ///< "stations", "vessels", ...
  std::vector<std::string_view> labels;  ///< columns of text: "vessel"
  std::vector<std::string_view> places;  ///< "place", "smallest_radius"
  std::vector<std::string_view> values;  ///< columns with their units: "length_mm"
  std::vector<MeasureRow> rows;
};

/// Number of kinds.
inline constexpr std::size_t kMeasureKinds = 6;

/// One table for each kind, in one order, also where it has no row. Measures are those of the case.
std::vector<MeasureTable> measureTables(const formats::Case& source, const CaseMeasures& measures);

}  // namespace lumen::convert
