// SPDX-License-Identifier: Apache-2.0
// Answers of `lumen check` and `lumen compare --json`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/check/check.h"
#include "converters/judge/compare/compare.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/judge/gate/gate.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// spec/answers/check.schema.json. `source`: whether the volume is the one that the case is of.
Json checkJson(const convert::CheckReport& report, const formats::CenterlineTree& tree,
               const std::string& source);
/// A table of the wall's offsets by branch, and lines on dark places, ends and missing vessels.
std::string checkText(const convert::CheckReport& report, const formats::CenterlineTree& tree);

// Answers about verdicts on checked cases.

/// Words of the command that opens the viewer at the verdict's worst place; empty if it has none.
std::vector<std::string> viewCommand(const convert::GateVerdict& verdict, const std::string& volume,
                                     const std::string& caseFile);

/// `verdict` in spec/answers/check.schema.json.
Json verdictJson(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                 const std::vector<std::string>& view);
/// Lines for people: the verdict, each fault, the worst place and the command that opens it.
std::string verdictText(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                        const std::vector<std::string>& view);

// Answer of `lumen compare --json`.

/// spec/answers/compare.schema.json.
Json comparisonJson(const convert::Comparison& comparison);

}  // namespace lumen::engine
