// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lumen::app {

/// SHA-256, lower-case hexadecimal.
std::string sha256(std::span<const std::byte> bytes);

}  // namespace lumen::app
