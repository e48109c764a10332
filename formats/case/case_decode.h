// SPDX-License-Identifier: Apache-2.0
// Decoding that collects what is wrong; nothing is returned after an error.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "formats/case/case.h"
#include "formats/container/issue.h"

namespace lumen::formats {

std::optional<Case> decodeBinary(std::span<const std::byte> bytes, IssueList& issues);
std::optional<Case> decodeJson(std::string_view text, IssueList& issues);

/// The rules of the model, the metadata and the node arrays.
void checkCase(const Case& value, IssueList& issues);

}  // namespace lumen::formats
