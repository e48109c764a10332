// SPDX-License-Identifier: Apache-2.0
// The checksum of headers, tables and chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lumen::formats {

/// CRC-32C (Castagnoli; reflected polynomial 0x82F63B78, initial value and final XOR 0xFFFFFFFF),
/// as in iSCSI, RFC 3720. The nine bytes "123456789" give 0xE3069283. To continue over a further
/// piece, pass the result for the pieces before it.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous = 0);

/// CRC-32C by tables alone, for processors without an instruction for it; crc32c() chooses.
std::uint32_t crc32cByTables(std::span<const std::byte> bytes, std::uint32_t previous = 0);

/// A checksum as it is shown: eight lower-case hexadecimal digits.
std::string checksumText(std::uint32_t checksum);

}  // namespace lumen::formats
