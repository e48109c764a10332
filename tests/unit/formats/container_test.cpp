// SPDX-License-Identifier: Apache-2.0
#include "formats/container/container.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "formats/container/crc32c.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;

Bytes bytesOf(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

Bytes twoChunks() {
  const std::vector<ChunkSource> chunks = {{chunkType("AAAA"), 1, true, bytesOf({1, 2, 3})},
                                           {chunkType("b999"), 7, false, Bytes(64, std::byte{9})}};
  return writeContainer(chunks);
}

std::string errorOf(std::span<const std::byte> bytes) {
  const auto container = readContainer(bytes);
  return container ? "OK" : errorName(container.error().code);
}

TEST(ByteCursor, GivesZeroAndStaysFailedPastTheEnd) {
  const Bytes bytes = bytesOf({1, 0, 2});
  ByteCursor cursor(bytes);
  EXPECT_EQ(cursor.read<std::uint16_t>(), 1);
  EXPECT_EQ(cursor.read<std::uint16_t>(), 0);
  EXPECT_EQ(cursor.read<std::uint8_t>(), 0);
  EXPECT_TRUE(cursor.failed());
}

TEST(ByteCursor, TakesNoMoreThanThereIs) {
  const Bytes bytes = bytesOf({1, 2});
  ByteCursor cursor(bytes);
  EXPECT_TRUE(cursor.take(std::size_t{0} - 1).empty());
  EXPECT_TRUE(cursor.failed());
}

TEST(LittleEndian, IsLowByteFirst) {
  Bytes bytes;
  appendLittle(bytes, std::uint32_t{0x04030201});
  appendLittle(bytes, 1.0f);
  EXPECT_EQ(bytes, bytesOf({1, 2, 3, 4, 0, 0, 0x80, 0x3f}));
  EXPECT_EQ(loadLittle<std::int16_t>(bytesOf({0xfe, 0xff}).data()), -2);
}

TEST(Container, StartsWithTheSignatureAndTheVersion) {
  const Bytes file = twoChunks();
  EXPECT_EQ(Bytes(file.begin(), file.begin() + 16),
            bytesOf({0x8c, 'L', 'U', 'M', 'E', 'N', 13, 10, 26, 10, 1, 1, 1, 0, 64, 0}));
}

TEST(Container, AlignsEveryChunkAndFillsUpWithZeros) {
  const Bytes file = twoChunks();
  ASSERT_EQ(file.size(), 320u);  // header 64, two entries 128, 3 bytes in 64, 64 bytes
  EXPECT_EQ(loadLittle<std::uint64_t>(&file[16]), 320u);
  EXPECT_EQ(file[192], std::byte{1});
  EXPECT_EQ(file[195], std::byte{0});
  EXPECT_EQ(file[256], std::byte{9});
}

TEST(Container, GivesBackWhatWasWritten) {
  const Bytes file = twoChunks();
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  ASSERT_EQ(container->chunks.size(), 2u);
  const Chunk& second = container->chunks[1];
  EXPECT_EQ(chunkName(second.type), "b999");
  EXPECT_EQ(second.version, 7);
  EXPECT_FALSE(second.critical);
  EXPECT_TRUE(container->chunks[0].critical);
  EXPECT_EQ(second.stored.data(), file.data() + 256);
  EXPECT_EQ(second.stored.size(), 64u);
  EXPECT_TRUE(verifyChunk(second));
}

TEST(Container, MayHoldNoChunkOrAnEmptyOne) {
  EXPECT_EQ(errorOf(writeContainer({})), "OK");
  const std::vector<ChunkSource> empty = {{chunkType("NONE"), 1, false, {}}};
  EXPECT_EQ(writeContainer(empty).size(), 128u);
  EXPECT_EQ(errorOf(writeContainer(empty)), "OK");
}

TEST(Container, FindsAChangedChunkOnlyWhenAskedToVerifyIt) {
  Bytes file = twoChunks();
  file[300] = std::byte{8};
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  EXPECT_TRUE(verifyChunk(container->chunks[0]));
  const auto verified = verifyChunk(container->chunks[1]);
  ASSERT_FALSE(verified);
  EXPECT_EQ(verified.error().code, ErrorCode::ChunkChecksum);
  EXPECT_EQ(verified.error().offset, 256u);
}

TEST(Container, IsRefusedAtEveryTruncation) {
  const Bytes file = twoChunks();
  for (std::size_t size = 0; size < file.size(); ++size) {
    const auto exact = std::make_unique<std::byte[]>(size);
    std::copy_n(file.begin(), size, exact.get());
    EXPECT_EQ(errorOf({exact.get(), size}), "TRUNCATED") << size;
  }
}

TEST(Container, IsRefusedWithAByteTooMany) {
  Bytes file = twoChunks();
  file.push_back(std::byte{0});
  EXPECT_EQ(errorOf(file), "TRAILING_BYTES");
}

TEST(Container, NamesALineEndConversionAsAWrongSignature) {
  Bytes file = twoChunks();
  file.erase(file.begin() + 6);  // CR LF became LF
  EXPECT_EQ(errorOf(file), "MAGIC");
}

// One fault, signed again so that only the rule itself can find it.
struct ContainerFaultRow {
  const char* name;
  std::size_t at;
  std::uint64_t value;
  std::size_t size;
  const char* code;
};

class ContainerFault : public testing::TestWithParam<ContainerFaultRow> {};

// spec: M1, M6, M7, M8, M9, M10, M11, M43
TEST_P(ContainerFault, IsFound) {
  const ContainerFaultRow& fault = GetParam();
  Bytes file = twoChunks();
  for (std::size_t i = 0; i < fault.size; ++i)
    file[fault.at + i] = static_cast<std::byte>(fault.value >> (8 * i));
  test::resign(file);
  EXPECT_EQ(errorOf(file), fault.code);
}

constexpr std::uint64_t kHuge = 0xffffffffffffffffu;

INSTANTIATE_TEST_SUITE_P(
    All, ContainerFault,
    testing::Values(ContainerFaultRow{"magic", 0, 'L', 1, "MAGIC"},
                    ContainerFaultRow{"major_version_zero", 10, 0, 1, "VERSION"},
                    ContainerFaultRow{"newer_minimum_reader", 10, 0x01020102, 4, "VERSION"},
                    ContainerFaultRow{"newer_major_version", 10, 0x00020002, 4, "VERSION"},
                    ContainerFaultRow{"minimum_reader_above_version", 13, 2, 1, "VERSION"},
                    ContainerFaultRow{"header_size", 14, 128, 2, "HEADER_FIELD"},
                    ContainerFaultRow{"reserved_header_byte", 40, 1, 1, "HEADER_FIELD"},
                    ContainerFaultRow{"length_beyond_file", 16, 384, 8, "TRUNCATED"},
                    ContainerFaultRow{"length_huge", 16, kHuge, 8, "TRUNCATED"},
                    ContainerFaultRow{"length_short", 16, 256, 8, "TRAILING_BYTES"},
                    ContainerFaultRow{"chunk_count_beyond_file", 24, 5, 4, "CHUNK_COUNT"},
                    ContainerFaultRow{"chunk_count_huge", 24, 0xffffffff, 4, "CHUNK_COUNT"},
                    ContainerFaultRow{"one_chunk_less", 24, 1, 4, "CHUNK_OFFSET"},
                    ContainerFaultRow{"type_with_space", 64, ' ', 1, "CHUNK_TYPE"},
                    ContainerFaultRow{"reserved_flag", 70, 5, 1, "CHUNK_FIELD"},
                    ContainerFaultRow{"reserved_entry_byte", 64 + 63, 1, 1, "CHUNK_FIELD"},
                    ContainerFaultRow{"hole", 72, 256, 8, "CHUNK_OFFSET"},
                    ContainerFaultRow{"overlap", 128 + 8, 192, 8, "CHUNK_OFFSET"},
                    ContainerFaultRow{"unaligned", 72, 193, 8, "CHUNK_OFFSET"},
                    ContainerFaultRow{"offset_huge", 72, kHuge, 8, "CHUNK_OFFSET"},
                    ContainerFaultRow{"size_huge", 80, kHuge, 8, "CHUNK_SIZE"},
                    ContainerFaultRow{"size_beyond_file", 128 + 16, 65, 8, "CHUNK_SIZE"},
                    ContainerFaultRow{"raw_size_differs", 88, 4, 8, "CHUNK_SIZE"},

                    ContainerFaultRow{"padding", 192 + 63, 1, 1, "CHUNK_PADDING"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Container, IsRefusedIfItsLastChunkEndsBeforeItDoes) {
  Bytes file = twoChunks();
  storeLittle(&file[128 + 16], std::uint64_t{0});  // both sizes of the second chunk
  storeLittle(&file[128 + 24], std::uint64_t{0});
  test::resign(file);
  EXPECT_EQ(errorOf(file), "TRAILING_BYTES");
}

// spec: M16, M42
TEST(Container, RefusesAnEncodedChunkThatExpandsToMoreThan256Times) {
  Bytes file = twoChunks();
  file[71] = std::byte{1};                         // zstd
  storeLittle(&file[88], std::uint64_t{3 * 256});  // raw size of 3 stored bytes
  test::resign(file);
  EXPECT_EQ(errorOf(file), "OK");
  storeLittle(&file[88], std::uint64_t{3 * 257 + 256});
  test::resign(file);
  EXPECT_EQ(errorOf(file), "CHUNK_EXPANSION");
  storeLittle(&file[88], kHuge);
  test::resign(file);
  EXPECT_EQ(errorOf(file), "CHUNK_EXPANSION");
}

// spec: M9
TEST(Container, FindsWrongHeaderAndTableChecksums) {
  Bytes header = twoChunks(), table = twoChunks();
  header[60] ^= std::byte{1};
  EXPECT_EQ(errorOf(header), "HEADER_CHECKSUM");
  table[64] ^= std::byte{1};
  EXPECT_EQ(errorOf(table), "TABLE_CHECKSUM");
}

// spec: M44
TEST(Container, IgnoresReservedBytesOfANewerMinorVersion) {
  Bytes file = twoChunks();
  file[11] = std::byte{3};   // version 1.3, readable from 1.0 on
  file[40] = std::byte{5};   // reserved in the header
  file[100] = std::byte{5};  // reserved in an entry
  test::resign(file);
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  EXPECT_FALSE(container->fullyKnown());
}

TEST(ErrorRules, HaveDifferentNames) {
  std::set<std::string> names;
  for (const ErrorRule& rule : errorRules()) EXPECT_TRUE(names.insert(rule.name).second);
  EXPECT_STREQ(errorName(ErrorCode::IoWrite), "IO_WRITE");
}

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
