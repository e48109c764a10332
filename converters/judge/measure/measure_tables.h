// SPDX-License-Identifier: Apache-2.0
// The measures of a case as tables, one for each kind: the form that files, pages and answers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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
  std::string_view system;    ///< of a vessel; empty if the case states none
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

// Differences between the measures of two cases of one patient (docs/measures.md, section 8).

/// For each branch of `after` the branch of `before` in whose lumen most of its nodes lie, if that
/// is at least half of them; each branch of `before` is given to the one with the most nodes in it.
/// Both cases lie in one frame.
std::vector<std::optional<std::uint32_t>> matchBranches(const formats::Case& before,
                                                        const formats::Case& after);

/// A case with its measures.
struct MeasuredCaseOf {
  const formats::Case& source;
  const CaseMeasures& measures;
};

/// Later less earlier values of the vessels that match, and of their paths, forks, narrowings and
/// aneurysms, each with its interval: the tables "vessel_changes", "path_changes", "fork_changes",
/// "narrowing_changes" and "sac_changes", whose last text is the vessel's name before; of a path
/// that of its end.
std::vector<MeasureTable> measureChanges(const MeasuredCaseOf& before, const MeasuredCaseOf& after);

}  // namespace lumen::convert
