// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/facts/reachable.h"

namespace lumen::engine {

/// length_mm, of_mm and closed; null for nothing.
Json reachJson(const std::optional<convert::Reach>& reach);

}  // namespace lumen::engine
