// SPDX-License-Identifier: Apache-2.0
// The compression function of SHA-256, for sha256.cpp and its test.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lumen {

using Sha256Words = std::array<std::uint32_t, 8>;
constexpr std::size_t kSha256Block = 64;  ///< bytes

/// Adds `count` blocks of 64 bytes to the state (FIPS 180-4, 6.2.2), by the processor's own
/// instructions where it has some.
void addBlocks(Sha256Words& state, const std::byte* blocks, std::size_t count);

/// The same without such instructions, everywhere.
void addBlocksPlainly(Sha256Words& state, const std::byte* blocks, std::size_t count);

}  // namespace lumen
