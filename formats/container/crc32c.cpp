// SPDX-License-Identifier: Apache-2.0
#include "formats/container/crc32c.h"

#include <array>

#include "formats/container/bytes.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define LUMEN_CRC32C_INSTRUCTION 1
#else
#define LUMEN_CRC32C_INSTRUCTION 0
#endif

namespace lumen::formats {
namespace {

constexpr std::uint32_t kPolynomial = 0x82f63b78u;
constexpr std::size_t kSlices = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

// tables[k][b] is the remainder of byte b followed by k zero bytes.
constexpr Tables makeTables() {
  Tables tables{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? kPolynomial : 0u);
    tables[0][b] = crc;
  }
  for (std::size_t k = 1; k < kSlices; ++k)
    for (std::size_t b = 0; b < 256; ++b) {
      const std::uint32_t before = tables[k - 1][b];
      tables[k][b] = (before >> 8) ^ tables[0][before & 0xffu];
    }
  return tables;
}

constexpr Tables kTables = makeTables();

#if LUMEN_CRC32C_INSTRUCTION
__attribute__((target("sse4.2,crc32"))) std::uint32_t byInstruction(
    std::span<const std::byte> bytes, std::uint32_t previous) {
  std::uint64_t crc = ~previous;
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8)
    crc = __builtin_ia32_crc32di(crc, loadLittle<std::uint64_t>(at));
  auto low = static_cast<std::uint32_t>(crc);
  for (; left > 0; --left, ++at) low = __builtin_ia32_crc32qi(low, static_cast<unsigned char>(*at));
  return ~low;
}
#endif

}  // namespace

// Slicing-by-8: Kounavis and Berry, "A systematic approach to building high performance
// software-based CRC generators", 2005.
std::uint32_t crc32cByTables(std::span<const std::byte> bytes, std::uint32_t previous) {
  std::uint32_t crc = ~previous;
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8) {
    const std::uint32_t low = loadLittle<std::uint32_t>(at) ^ crc;
    const std::uint32_t high = loadLittle<std::uint32_t>(at + 4);
    crc = kTables[7][low & 0xffu] ^ kTables[6][(low >> 8) & 0xffu] ^
          kTables[5][(low >> 16) & 0xffu] ^ kTables[4][low >> 24] ^ kTables[3][high & 0xffu] ^
          kTables[2][(high >> 8) & 0xffu] ^ kTables[1][(high >> 16) & 0xffu] ^
          kTables[0][high >> 24];
  }
  for (; left > 0; --left, ++at)
    crc = (crc >> 8) ^ kTables[0][(crc ^ static_cast<std::uint32_t>(*at)) & 0xffu];
  return ~crc;
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous) {
#if LUMEN_CRC32C_INSTRUCTION
  static const bool hasInstruction = __builtin_cpu_supports("sse4.2") != 0;
  if (hasInstruction) return byInstruction(bytes, previous);
#endif
  return crc32cByTables(bytes, previous);
}

std::string checksumText(std::uint32_t checksum) {
  std::string text;
  for (int shift = 28; shift >= 0; shift -= 4)
    text += "0123456789abcdef"[(checksum >> shift) & 0xfu];
  return text;
}

}  // namespace lumen::formats
