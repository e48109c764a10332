// SPDX-License-Identifier: Apache-2.0
// Text of unknown origin, fit for a terminal or a log.
#pragma once

#include <string>
#include <string_view>

namespace lumen::formats {

/// `text` with all escaped that would not show as itself, or would change what stands around it: a
/// byte that is not UTF-8 becomes \xNN; control characters, line and paragraph separators, marks
/// of direction and characters without width become \uNNNN (beyond U+FFFF \UNNNNNNNN). All else
/// stays, a backslash too, so escaping twice changes nothing. The result is one line of UTF-8.
/// Every text from a file, and every name of a file, is printed through this function.
std::string printable(std::string_view text);

}  // namespace lumen::formats
