// SPDX-License-Identifier: Apache-2.0
// Answer of `lumen compare --json`.
#pragma once

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/compare/compare.h"

namespace lumen::engine {

/// spec/answers/compare.schema.json.
Json comparisonJson(const convert::Comparison& comparison);

}  // namespace lumen::engine
