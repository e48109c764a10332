// SPDX-License-Identifier: Apache-2.0
// Answers about verdicts on checked cases.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/gate/gate.h"

namespace lumen::engine {

/// Words of the command that opens the viewer at the verdict's worst place; empty if it has none.
std::vector<std::string> viewCommand(const convert::GateVerdict& verdict, const std::string& volume,
                                     const std::string& caseFile);

/// `verdict` in spec/answers/check.schema.json.
Json verdictJson(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                 const std::vector<std::string>& view);
/// Lines for people: the verdict, each fault, the worst place and the command that opens it.
std::string verdictText(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                        const std::vector<std::string>& view);

/// Words as a line for a shell.
std::string shellLine(const std::vector<std::string>& words);

}  // namespace lumen::engine
