// SPDX-License-Identifier: Apache-2.0
// What every text in a case must be.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/case/case_file.h"

namespace lumen::formats {

/// True for well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF).
bool isUtf8(std::string_view text);

/// TEXT_LENGTH, TEXT_UTF8, TEXT_CONTROL (U+0000 to U+001F, U+007F to U+009F), or nothing.
std::optional<FormatError> checkText(std::string_view text, std::size_t maxBytes,
                                     const std::string& place);

}  // namespace lumen::formats
