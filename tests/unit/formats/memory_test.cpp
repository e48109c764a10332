// SPDX-License-Identifier: Apache-2.0
// Memory that decoding asks for, against the bytes that are there.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "unit/formats/allocation_meter.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;

template <class Call>
std::size_t peakOf(Call call) {
  test::startMeter();
  call();
  return test::peakBytes();
}

// Decoding may take this times the size of the text, and a little: most for tiny values in many
// arrays.
constexpr std::size_t kFactor = 40;
constexpr std::size_t kConstant = 20000;

void expectBounded(const std::string& text) {
  const std::size_t used = peakOf([&] { EXPECT_FALSE(decodeJson(text)); });
  EXPECT_LE(used, kFactor * text.size() + kConstant) << text.substr(0, 60);
}

std::string repeated(std::string text, const std::string& piece, std::size_t count,
                     const std::string& end) {
  for (std::size_t i = 0; i < count; ++i) text += piece;
  return text += end;
}

TEST(Memory, OfDecodingJsonIsBoundedByItsText) {
  for (const std::size_t count : {100u, 100000u}) {
    for (const char* piece : {"[],", "{},", "0,"})
      expectBounded(repeated("{\"metadata\":{\"steps\":[", piece, count, "0]}}"));
    expectBounded(repeated("[", "\"\",", count, "0]"));
    expectBounded(repeated("{\"otherChunks\":[", "{\"data\":\"AAAA\"},", count, "0]}"));
    expectBounded(repeated("{\"tree\":{\"links\":[", "[],", count, ""));
    expectBounded(repeated("{\"nodeArrays\":{\"a\":[", "0,", count, ""));
    std::string arrays = "{\"nodeArrays\":{";
    for (std::size_t i = 0; i < count; ++i)
      arrays.append("\"").append(std::to_string(i)).append("\":[],");
    expectBounded(arrays + "\"\":0}}");
    expectBounded(repeated("{\"tree\":{\"centre\":[", "[],", count, ""));
    expectBounded(repeated("{\"tree\":{\"radius\":[", "0,", count, ""));
    std::string keys = "{";
    for (std::size_t i = 0; i < count; ++i)
      keys.append("\"").append(std::to_string(i)).append("\":0,");
    expectBounded(keys + "\"\":0}");
  }
}

// spec: M42
TEST(Memory, OfDecodingHostileCountsIsNotAskedFor) {
  // every 32-bit word of header, table and records becomes huge in turn
  const Bytes good = encodeBinary(test::richCase());
  for (std::size_t at = 0; at + 4 <= good.size(); at += 4) {
    Bytes file = good;
    storeLittle(&file[at], 0xfffffff0u);
    test::resign(file);
    const std::size_t used = peakOf([&] { (void)decodeBinary(file); });
    EXPECT_LE(used, kFactor * file.size()) << at;
  }
}

TEST(Memory, OfDecodingBinaryIsAboutThatOfTheFile) {
  const Bytes file = encodeBinary(test::longCase(1000, 100, 6));
  const std::size_t used = peakOf([&] { EXPECT_TRUE(decodeBinary(file)); });
  EXPECT_LE(used, 2 * file.size());
}

}  // namespace
}  // namespace lumen::formats
