// SPDX-License-Identifier: Apache-2.0
// zstd and Draco: what they give back, and what hostile streams get.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "formats/container/bytes.h"
#include "formats/view/case_view.h"
#include "unit/formats/allocation_meter.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;
using test::codeOf;
using test::dataOf;
using test::entryOf;

Bytes compressed() {
  return encodeBinary(test::longCase(300, 4, 3), {true, 0});
}
Bytes quantised(int bits) {
  return encodeBinary(test::longCase(300, 4, 3), {false, bits});
}

int encodingOf(const Bytes& file, const std::string& type) {
  return static_cast<int>(file[entryOf(file, type) + 7]);
}

// spec: M17, M18
TEST(Zstd, GivesBackEveryBitAndIsSmaller) {
  const Case value = test::longCase(300, 4, 3);
  const Bytes raw = encodeBinary(value), small = compressed();
  EXPECT_LT(small.size(), raw.size() * 3 / 4);
  EXPECT_EQ(encodingOf(small, "NPAR"), 1);
  const auto decoded = decodeBinary(small);
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(encodeBinary(*decoded), raw);
}

TEST(Zstd, LeavesAChunkRawThatItDoesNotMakeSmaller) {
  EXPECT_EQ(encodeBinary(test::smallestCase(), {true, 0}), encodeBinary(test::smallestCase()));
}

// A chunk of zeros would shrink further than a reader may be asked to expand it.
// spec: M16
TEST(Zstd, LeavesAChunkRawThatItMakesTooSmall) {
  Case value = test::longCase(20000, 0, 0);
  value.tree.inlierRate.assign(20000, 0.0f);
  const Bytes file = encodeBinary(value, {true, 0});
  EXPECT_EQ(encodingOf(file, "NINL"), 0);
  EXPECT_TRUE(decodeBinary(file));
}

// spec: M20
TEST(Draco, RoundsPointsByLessThanAStepAndKeepsTheirOrder) {
  const Case value = test::longCase(300, 4, 3);
  const auto decoded = decodeBinary(quantised(12));
  ASSERT_TRUE(decoded) << decoded.error().text();
  ASSERT_TRUE(decoded->metadata.pointQuantisation);
  EXPECT_EQ(decoded->metadata.pointQuantisation->bits, 12);
  const double step = decoded->metadata.pointQuantisation->step;
  EXPECT_NEAR(step, 41.0 / 4095, 0.1 / 4095);  // the longest edge, in 2^12 - 1 steps
  ASSERT_EQ(decoded->points->position.size(), value.points->position.size());
  EXPECT_EQ(decoded->points->offset, value.points->offset);
  for (std::size_t i = 0; i < value.points->position.size(); ++i) {
    const Vec3f a = value.points->position[i], b = decoded->points->position[i];
    for (const double d :
         {double{a.x} - double{b.x}, double{a.y} - double{b.y}, double{a.z} - double{b.z}})
      ASSERT_LE(std::abs(d), 0.5 * step * 1.001) << i;
  }
}

TEST(Draco, IsSmallerThanRawPoints) {
  const Bytes file = quantised(12);
  EXPECT_EQ(encodingOf(file, "PPOS"), 2);
  EXPECT_LT(loadLittle<std::uint64_t>(&file[entryOf(file, "PPOS") + 16]), 1200u * 12 / 2);
}

TEST(Draco, EqualsQuantisingFirst) {
  Case value = test::longCase(300, 4, 3);
  quantisePoints(value, 12);
  const auto decoded = decodeBinary(quantised(12));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(*decoded, value);
}

TEST(Draco, TakesPointsThatAreAllOneOrNone) {
  Case value = test::smallestCase();
  value.points = PointSets{{0, 3}, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}};
  const auto decoded = decodeBinary(encodeBinary(value, {false, 8}));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->points->position, value.points->position);
  value.points = PointSets{{0, 0}, {}};
  EXPECT_EQ(encodeBinary(value, {false, 8}), encodeBinary(value));
}

TEST(Draco, RefusesBitsThatItDoesNotHave) {
  Case value = test::richCase();
  EXPECT_THROW(quantisePoints(value, 0), std::invalid_argument);
  EXPECT_THROW(quantisePoints(value, 31), std::invalid_argument);
}

// spec: M21
TEST(EncodedChunk, CannotBeViewedAndIsNamed) {
  const Bytes file = quantised(12);
  const auto view = viewCase(file, Verify::Structure);
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().code, ErrorCode::ChunkEncoding);
  EXPECT_NE(view.error().message.find("PPOS"), std::string::npos);
  EXPECT_EQ(view.error().offset, entryOf(file, "PPOS") + 7);
}

// spec: M17, M18
TEST(EncodedChunk, OfTwoFramesOrOfAnotherSizeIsRefused) {
  Bytes file = compressed();
  const std::size_t entry = entryOf(file, "NPAR");
  storeLittle(&file[entry + 24], loadLittle<std::uint64_t>(&file[entry + 24]) - 4);
  test::resign(file);
  EXPECT_EQ(codeOf(decodeBinary(file)), "CHUNK_DECODE");
}

// spec: M19
TEST(EncodedChunk, OfAnotherTypeThanPointsIsNoDraco) {
  Bytes file = compressed();
  file[entryOf(file, "NPAR") + 7] = std::byte{2};
  test::resign(file);
  EXPECT_EQ(codeOf(decodeBinary(file)), "CHUNK_ENCODING");
}

// Every byte of the encoded chunks changed in turn, checksums made right: the decoders see it.
void expectBoundedMemory(const Bytes& good, const std::string& type) {
  const std::size_t at = dataOf(good, type);
  const auto size =
      static_cast<std::size_t>(loadLittle<std::uint64_t>(&good[entryOf(good, type) + 16]));
  // what the decoder holds whatever the data: zstd's context, Draco's tables
  constexpr std::size_t kDecoder = 6u << 20;
  for (std::size_t i = 0; i < std::min<std::size_t>(size, 400); ++i)
    for (const int mask : {0xff, 0x80, 0x01}) {
      Bytes file = good;
      file[at + i] ^= static_cast<std::byte>(mask);
      test::resign(file);
      test::startMeter();
      const auto decoded = decodeBinary(file);
      EXPECT_LE(test::peakBytes(), 40 * file.size() + kDecoder) << type << " byte " << i;
      if (decoded) {
        EXPECT_TRUE(validate(*decoded));
      }
    }
}

// spec: M42
TEST(EncodedChunk, OfHostileZstdAsksForBoundedMemory) {
  expectBoundedMemory(compressed(), "NPAR");
}

// spec: M20, M42
TEST(EncodedChunk, OfHostileDracoAsksForBoundedMemory) {
  expectBoundedMemory(quantised(12), "PPOS");
}

// spec: M42
TEST(EncodedChunk, OfRandomBytesBehindADracoHeadAsksForBoundedMemory) {
  const Bytes good = quantised(12);
  const std::size_t at = dataOf(good, "PPOS");
  const auto size =
      static_cast<std::size_t>(loadLittle<std::uint64_t>(&good[entryOf(good, "PPOS") + 16]));
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    Bytes file = good;
    for (std::size_t i = 23; i < size; ++i) file[at + i] = static_cast<std::byte>(random.next());
    test::resign(file);
    test::startMeter();
    (void)decodeBinary(file);
    EXPECT_LE(test::peakBytes(), 40 * file.size() + (6u << 20)) << trial;
  }
}

}  // namespace
}  // namespace lumen::formats
