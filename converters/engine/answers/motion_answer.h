// SPDX-License-Identifier: Apache-2.0
// Answer of `lumen motion`.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/operations/moved.h"

namespace lumen::engine {

/// An array with time_s, farthest_mm, seen, correction_mm and fitted_nodes of each phase.
Json phasesJson(const operations::MovedCase& moved);

/// A line for each phase with its time, the greatest displacement and the share that is seen.
/// `names`: the phases, for people.
std::string phaseLines(const operations::MovedCase& moved, const std::vector<std::string>& names);

}  // namespace lumen::engine
