// SPDX-License-Identifier: Apache-2.0
// Texts of cases in Markdown (CommonMark 0.30, and GitHub's tables, strikethrough and addresses).
#pragma once

#include <string>
#include <string_view>

namespace lumen::convert {

/// `text` as one line that shows as itself, also in the cell of a table and at the beginning of a
/// paragraph: no character of it is markup, and characters that do not show are written out
/// (formats::printable()).
std::string markdownText(std::string_view text);

}  // namespace lumen::convert
