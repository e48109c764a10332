// SPDX-License-Identifier: Apache-2.0
// The facts of a case as `lumen info` prints them.
#pragma once

#include <optional>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/facts/case_info.h"
#include "converters/judge/facts/reachable.h"

namespace lumen::engine {

/// branches, nodes, links, points, blobs, blobs_per_node, length_mm, radius_mm, error_of_fit_mm,
/// provenance, note, node_arrays, seeds. A value that the case does not have is null.
Json caseInfoJson(const convert::CaseInfo& info);
/// `inlets`: inletsText() of the case.
std::string caseInfoText(const convert::CaseInfo& info, const std::string& inlets);

/// Steps of a case: name, tool and parameters of each.
Json stepsJson(const formats::Metadata& metadata);

/// length_mm, of_mm and closed; null for nothing.
Json reachJson(const std::optional<convert::Reach>& reach);

}  // namespace lumen::engine
