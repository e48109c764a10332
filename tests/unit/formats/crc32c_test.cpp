// SPDX-License-Identifier: Apache-2.0
#include "formats/container/crc32c.h"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::formats {
namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// The polynomial, bit by bit.
std::uint32_t reference(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte b : bytes) {
    crc ^= static_cast<std::uint32_t>(b);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? 0x82f63b78u : 0u);
  }
  return ~crc;
}

TEST(Crc32c, GivesThePublishedCheckValue) {
  EXPECT_EQ(crc32c(bytesOf("123456789")), 0xe3069283u);
}

TEST(Crc32c, GivesTheVectorsOfRfc3720) {
  EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0})), 0x8a9136aau);
  EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0xff})), 0x62a8ab43u);
  std::vector<std::byte> rising;
  for (int i = 0; i < 32; ++i) rising.push_back(static_cast<std::byte>(i));
  EXPECT_EQ(crc32c(rising), 0x46dd794eu);
}

TEST(Crc32c, IsZeroForNoBytes) {
  EXPECT_EQ(crc32c({}), 0u);
}

TEST(Crc32c, AgreesWithTheBitwiseDefinitionForEveryLengthAndStart) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < 80; ++i) bytes.push_back(static_cast<std::byte>(i * i + 7 * i + 3));
  const std::span<const std::byte> all(bytes);
  for (std::size_t start = 0; start < 8; ++start)
    for (std::size_t size = 0; start + size <= all.size(); ++size) {
      const auto piece = all.subspan(start, size);
      ASSERT_EQ(crc32c(piece), reference(piece));
      ASSERT_EQ(crc32cByTables(piece), reference(piece));
    }
}

TEST(Crc32c, ContinuesOverPieces) {
  EXPECT_EQ(crc32c(bytesOf("56789"), crc32c(bytesOf("1234"))), 0xe3069283u);
  EXPECT_EQ(crc32cByTables(bytesOf("56789"), crc32cByTables(bytesOf("1234"))), 0xe3069283u);
}

}  // namespace
}  // namespace lumen::formats
