// SPDX-License-Identifier: Apache-2.0
// The digest by which a case names its volume and its parent.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lumen {

/// SHA-256 (FIPS 180-4), 64 lower-case hexadecimal digits. Throws Error(Failed) if the cryptography
/// library does not offer it.
std::string sha256(std::span<const std::byte> bytes);

}  // namespace lumen
