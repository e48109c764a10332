// SPDX-License-Identifier: Apache-2.0
// The JSON encoding, `.lumen.json`: from text to a case. See spec/lumen.md, "JSON encoding".
#pragma once

#include <optional>
#include <string_view>

#include "formats/case/case.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// The case that the text holds, validated. Never throws for bad input; memory is bounded by the
/// text. Keys that start with "x-" are dropped.
Expected<Case> decodeJson(std::string_view text);

/// Adds every issue of the text to `issues`, too; nothing is returned after an error.
std::optional<Case> decodeJson(std::string_view text, IssueList& issues);

}  // namespace lumen::formats
