// SPDX-License-Identifier: Apache-2.0
// Answer of `lumen check --json`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/check/check.h"
#include "converters/judge/facts/check_facts.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// spec/answers/check.schema.json. `source`: whether the volume is the one that the case is of.
Json checkJson(const convert::CheckReport& report, const formats::CenterlineTree& tree,
               const std::string& source);

}  // namespace lumen::engine
