// SPDX-License-Identifier: Apache-2.0
// Bytes as text: RFC 4648, section 4, with padding and without line ends.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumen::formats {

std::string base64(std::span<const std::byte> bytes);

/// The bytes of a text; nothing if it is not base64. Unused bits must be zero, so that bytes have
/// exactly one text.
std::optional<std::vector<std::byte>> fromBase64(std::string_view text);

}  // namespace lumen::formats
