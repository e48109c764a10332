// SPDX-License-Identifier: Apache-2.0
// The secret of the page.
#pragma once

#include <string>
#include <string_view>

namespace lumen::viewer {

/// 128 random bits of the operating system as 32 hexadecimal digits. Throws Error(Failed).
std::string randomToken();

/// True if two texts are equal. The time does not depend on the place where they differ.
bool sameSecret(std::string_view a, std::string_view b);

}  // namespace lumen::viewer
