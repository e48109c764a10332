// SPDX-License-Identifier: Apache-2.0
// What only the page knows that was opened from here.
#pragma once

#include <string>
#include <string_view>

namespace lumen::viewer {

/// 128 random bits of the operating system as 32 hexadecimal digits. Throws Error(Failed).
std::string randomToken();

/// Whether two texts are equal, in a time that does not tell where they differ.
bool sameSecret(std::string_view a, std::string_view b);

}  // namespace lumen::viewer
