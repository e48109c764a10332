// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;
using test::codeOf;
using test::dataOf;
using test::entryOf;
using test::tampered;

TEST(Binary, GivesBackEveryField) {
  const auto decoded = decodeBinary(encodeBinary(test::richCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::richCase());
}

TEST(Binary, GivesBackATreeAlone) {
  const auto decoded = decodeBinary(encodeBinary(test::smallestCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::smallestCase());
}

TEST(Binary, GivesBackEmptyPointSets) {
  Case value = test::smallestCase();
  value.points = PointSets{{0, 0}, {}};
  const auto decoded = decodeBinary(encodeBinary(value));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, value);
}

TEST(Binary, GivesEqualCasesEqualBytes) {
  Case negative = test::richCase(), positive = test::richCase();
  negative.tree.centre[0].x = -0.0f;
  negative.metadata.source->origin[1] = -0.0;
  positive.metadata.source->origin[1] = 0.0;
  ASSERT_EQ(negative, positive);
  EXPECT_EQ(encodeBinary(negative), encodeBinary(positive));
}

TEST(Binary, HasTheSizesOfTheSpecificationsExample) {
  // header 64, 9 entries 576, metadata of 50 bytes, 8 more chunks, each in one line of 64 bytes
  EXPECT_EQ(encodeBinary(test::smallestCase()).size(), 64u + 9 * 64 + 9 * 64);
}

TEST(Binary, KeepsArraysInPlaceForAMappingReader) {
  const Bytes file = encodeBinary(test::richCase());
  const std::size_t at = dataOf(file, "MWID");
  EXPECT_EQ(at % 64, 0u);
  EXPECT_EQ(loadLittle<float>(&file[at + 4]), 0.2f);
}

TEST(Binary, IsRefusedAtEveryTruncation) {
  const Bytes file = encodeBinary(test::richCase());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const auto exact = std::make_unique<std::byte[]>(size);
    std::copy_n(file.begin(), size, exact.get());
    ASSERT_EQ(codeOf(decodeBinary({exact.get(), size})), "TRUNCATED") << size;
  }
}

TEST(Binary, IsRefusedAtEveryTruncationThatIsSignedAgain) {
  const Bytes file = encodeBinary(test::smallestCase());
  for (std::size_t size = 64; size < file.size(); ++size) {
    Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    storeLittle(&cut[16], std::uint64_t{size});
    test::resign(cut);
    ASSERT_FALSE(decodeBinary(cut)) << size;
  }
}

TEST(Binary, IsRefusedAfterEverySingleBitFlip) {
  Bytes file = encodeBinary(test::richCase());
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1u << (bit % 8));
    file[bit / 8] ^= mask;
    ASSERT_FALSE(decodeBinary(file)) << "bit " << bit;
    file[bit / 8] ^= mask;
  }
}

// Changes one byte of the chunk's content and signs again: validation must not be fooled or crash.
TEST(Binary, SurvivesEveryChangedByteOfEveryChunk) {
  const Bytes file = encodeBinary(test::richCase());
  std::size_t accepted = 0;
  for (std::size_t at = 64; at < file.size(); ++at) {
    Bytes changed = file;
    changed[at] ^= std::byte{0xff};
    test::resign(changed);
    if (const auto decoded = decodeBinary(changed)) {
      ++accepted;
      EXPECT_TRUE(validate(*decoded)) << at;
      EXPECT_EQ(encodeBinary(*decoded).size(), changed.size()) << at;
    }
  }
  EXPECT_GT(accepted, 0u);  // some bytes are the low parts of coordinates
}

// spec: M12
TEST(Binary, RefusesAnUnknownCriticalChunkByName) {
  const auto result =
      decodeBinary(tampered([](Bytes& f) { f[entryOf(f, "NRAD")] = std::byte{'Q'}; }));
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), "CHUNK_UNKNOWN");
  EXPECT_NE(result.error().message.find("QRAD"), std::string::npos);
}

// spec: M13, M14
TEST(Binary, KeepsUnknownChunksThatAreNotCritical) {
  Case expected = test::richCase();
  expected.tree.inlierRate.clear();
  const Bytes good = encodeBinary(test::richCase());
  const auto rates = good.begin() + static_cast<std::ptrdiff_t>(dataOf(good, "NINL"));
  expected.otherChunks = {{"qINL", 1, false, 0, 24, Bytes(rates, rates + 24)}};
  const auto result =
      decodeBinary(tampered([](Bytes& f) { f[entryOf(f, "NINL")] = std::byte{'q'}; }));
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(*result, expected);
}

// spec: M13
TEST(Binary, IgnoresTheEncodingOfAnUnknownChunk) {
  EXPECT_EQ(codeOf(decodeBinary(tampered([](Bytes& f) {
              const std::size_t entry = entryOf(f, "NINL");
              f[entry] = std::byte{'q'};
              f[entry + 7] = std::byte{9};
              f[entry + 24] = std::byte{99};
            }))),
            "OK");
}

// spec: M9, M13
TEST(Binary, ChecksTheBytesOfChunksThatItIgnores) {
  Bytes file = tampered([](Bytes& f) { f[entryOf(f, "NINL")] = std::byte{'q'}; });
  file[dataOf(file, "qINL")] ^= std::byte{1};
  EXPECT_EQ(codeOf(decodeBinary(file)), "CHUNK_CHECKSUM");
}

struct BinaryFaultRow {
  const char* name;
  void (*change)(Bytes&);
  const char* code;
};

void rename(Bytes& file, const std::string& from, const char (&to)[5]) {
  storeLittle(&file[entryOf(file, from)], chunkType(to));
}
template <class T>
void setData(Bytes& file, const std::string& type, std::size_t at, T value) {
  storeLittle(&file[dataOf(file, type) + at], value);
}
// A shorter chunk in the same line of 64 bytes; the rest becomes padding.
void shorten(Bytes& file, const std::string& type, std::uint64_t size) {
  const std::size_t entry = entryOf(file, type), data = dataOf(file, type);
  for (auto at = size; at < loadLittle<std::uint64_t>(&file[entry + 16]); ++at)
    file[data + at] = std::byte{0};
  storeLittle(&file[entry + 16], size);
  storeLittle(&file[entry + 24], size);
}

class BinaryFault : public testing::TestWithParam<BinaryFaultRow> {};

// spec: M1, M22, M23, M24, M26, M27, M28
TEST_P(BinaryFault, IsFound) {
  EXPECT_EQ(codeOf(decodeBinary(tampered(GetParam().change))), GetParam().code);
}

INSTANTIATE_TEST_SUITE_P(
    All, BinaryFault,
    testing::Values(
        BinaryFaultRow{"chunk_version", [](Bytes& f) { f[entryOf(f, "NRAD") + 4] = std::byte{2}; },
                       "CHUNK_VERSION"},
        BinaryFaultRow{"chunk_encoding", [](Bytes& f) { f[entryOf(f, "NRAD") + 7] = std::byte{3}; },
                       "CHUNK_ENCODING"},
        BinaryFaultRow{"draco_radii", [](Bytes& f) { f[entryOf(f, "NRAD") + 7] = std::byte{2}; },
                       "CHUNK_ENCODING"},
        BinaryFaultRow{"no_zstd_frame", [](Bytes& f) { f[entryOf(f, "NRAD") + 7] = std::byte{1}; },
                       "CHUNK_DECODE"},
        BinaryFaultRow{"no_draco_cloud", [](Bytes& f) { f[entryOf(f, "PPOS") + 7] = std::byte{2}; },
                       "CHUNK_DECODE"},
        BinaryFaultRow{"not_critical", [](Bytes& f) { f[entryOf(f, "NRAD") + 6] = std::byte{0}; },
                       "CHUNK_FIELD"},
        BinaryFaultRow{"needlessly_critical",
                       [](Bytes& f) { f[entryOf(f, "PPOS") + 6] = std::byte{1}; }, "CHUNK_FIELD"},
        BinaryFaultRow{"twice", [](Bytes& f) { rename(f, "NHEI", "NRAD"); }, "CHUNK_DUPLICATE"},
        BinaryFaultRow{"points_without_offsets", [](Bytes& f) { rename(f, "POFF", "qOFF"); },
                       "CHUNK_MISSING"},
        BinaryFaultRow{"models_without_kernel", [](Bytes& f) { rename(f, "MKER", "qKER"); },
                       "CHUNK_MISSING"},
        BinaryFaultRow{"partial_float", [](Bytes& f) { shorten(f, "NRAD", 23); }, "CHUNK_LENGTH"},
        BinaryFaultRow{"partial_vector", [](Bytes& f) { shorten(f, "PPOS", 44); }, "CHUNK_LENGTH"},
        BinaryFaultRow{"one_node_less", [](Bytes& f) { shorten(f, "NRAD", 20); }, "CHUNK_LENGTH"},
        BinaryFaultRow{"partial_branch", [](Bytes& f) { shorten(f, "BREC", 71); }, "CHUNK_LENGTH"},
        BinaryFaultRow{"kernel_record_short", [](Bytes& f) { shorten(f, "MKER", 23); },
                       "CHUNK_LENGTH"},
        BinaryFaultRow{"kernel_reserved", [](Bytes& f) { setData(f, "MKER", 3, std::uint8_t{1}); },
                       "CHUNK_FIELD"},
        BinaryFaultRow{"labels_short", [](Bytes& f) { shorten(f, "BLAB", 10); }, "CHUNK_LENGTH"},
        BinaryFaultRow{"label_size",
                       [](Bytes& f) { setData(f, "BREC", 16, std::uint16_t{0xffff}); },
                       "LABEL_OFFSET"},
        BinaryFaultRow{"label_offset", [](Bytes& f) { setData(f, "BREC", 24 + 12, 7u); },
                       "LABEL_OFFSET"},
        BinaryFaultRow{"label_bytes_left",
                       [](Bytes& f) { setData(f, "BREC", 48 + 16, std::uint16_t{3}); },
                       "CHUNK_LENGTH"},
        BinaryFaultRow{"label_utf8", [](Bytes& f) { setData(f, "BLAB", 0, std::uint8_t{0xff}); },
                       "TEXT_UTF8"},
        BinaryFaultRow{"node_count_hostile", [](Bytes& f) { setData(f, "BREC", 4, 0xffffffffu); },
                       "BRANCH_RANGE"},
        BinaryFaultRow{"offset_hostile", [](Bytes& f) { setData(f, "POFF", 24, 0xffffffffu); },
                       "OFFSET_END"},
        BinaryFaultRow{"radius_nan", [](Bytes& f) { setData(f, "NRAD", 8, std::nanf("")); },
                       "NOT_FINITE"},
        BinaryFaultRow{"mean_rate_nan", [](Bytes& f) { setData(f, "BREC", 20, std::nanf("")); },
                       "NOT_FINITE"},
        BinaryFaultRow{"mean_rate_negative", [](Bytes& f) { setData(f, "BREC", 20, -0.5f); },
                       "INLIER_RATE_RANGE"},
        BinaryFaultRow{"metadata_empty",
                       [](Bytes& f) {
                         rename(f, "META", "qETA");
                         rename(f, "NHEI", "META");
                       },
                       "CHUNK_UNKNOWN"},
        BinaryFaultRow{"metadata_syntax",
                       [](Bytes& f) { setData(f, "META", 0, std::uint8_t{'['}); }, "JSON_SYNTAX"},
        BinaryFaultRow{"metadata_key", [](Bytes& f) { setData(f, "META", 2, std::uint8_t{'C'}); },
                       "JSON_KEY_MISSING"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Binary, PlacesSyntaxErrorsOfTheMetadataByTheirByteInTheFile) {
  const Bytes file = tampered([](Bytes& f) { setData(f, "META", 1, std::uint8_t{'}'}); });
  const auto result = decodeBinary(file);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().place(), "byte " + std::to_string(dataOf(file, "META") + 2));
}

// spec: M43, M44
TEST(Binary, IgnoresUnknownMetadataOfANewerMinorVersionOnly) {
  const auto renameVoxelSize = [](Bytes& f) {
    const std::size_t at = dataOf(f, "META");
    const std::string key = "voxelSize";
    const auto begin = f.begin() + static_cast<std::ptrdiff_t>(at);
    const auto found = std::search(begin, f.end(), key.begin(), key.end(),
                                   [](std::byte b, char c) { return static_cast<char>(b) == c; });
    *found = std::byte{'V'};
  };
  EXPECT_EQ(codeOf(decodeBinary(tampered(renameVoxelSize))), "JSON_KEY_UNKNOWN");
  const auto newer = decodeBinary(tampered([&](Bytes& f) {
    renameVoxelSize(f);
    f[11] = std::byte{3};  // version 1.3, readable from 1.0 on
  }));
  ASSERT_TRUE(newer) << newer.error().text();
  EXPECT_FALSE(newer->metadata.voxelSize.has_value());
}

}  // namespace
}  // namespace lumen::formats
