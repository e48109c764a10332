// SPDX-License-Identifier: Apache-2.0
// Differences between the measures of two cases of one patient (docs/measures.md, section 8).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "converters/judge/measure/measure_tables.h"
#include "formats/case/case.h"

namespace lumen::convert {

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
