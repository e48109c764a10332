// SPDX-License-Identifier: Apache-2.0
// The bone of a scan without contrast in answers.
#pragma once

#include <optional>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/stages/native/subtract_native.h"

namespace lumen::engine {

/// Null without a scan.
Json nativeJson(const std::optional<convert::NativeReport>& report);
/// A line for the scan and one for each piece of its bone; empty without a scan.
std::string nativeLines(const std::optional<convert::NativeReport>& report);

}  // namespace lumen::engine
