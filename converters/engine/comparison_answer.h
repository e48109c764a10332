// SPDX-License-Identifier: Apache-2.0
// What `lumen compare --json` answers.
#pragma once

#include "converters/engine/answer_text.h"
#include "converters/judge/compare/compare.h"

namespace lumen::engine {

/// spec/answers/compare.schema.json.
Json comparisonJson(const convert::Comparison& comparison);

}  // namespace lumen::engine
