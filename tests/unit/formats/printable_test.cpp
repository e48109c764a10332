// SPDX-License-Identifier: Apache-2.0
#include "formats/container/printable.h"

#include <random>

#include <gtest/gtest.h>

#include "formats/container/utf8.h"

namespace lumen::formats {
namespace {

TEST(Printable, LeavesOrdinaryTextAlone) {
  for (const std::string text :
       {"", "aneurysm 3", "A. carotis interna \xe2\x80\x93 links",
        "\xe8\x84\x91\xe5\x8a\xa8\xe8\x84\x89", "\xd8\xb4\xd8\xb1\xd9\x8a\xd8\xa7\xd9\x86",
        "C:\\data\\x.lumen", "\xf0\x9f\xa7\xa0"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesEveryControlCharacter) {
  EXPECT_EQ(printable("a\nvalid: b"), "a\\u000avalid: b");
  EXPECT_EQ(printable(std::string("\0\x1b[2J\x7f", 6)), "\\u0000\\u001b[2J\\u007f");
  EXPECT_EQ(printable("\xc2\x85\xc2\x9b"), "\\u0085\\u009b");
}

TEST(Printable, EscapesWhatTurnsHidesOrBreaksTheLine) {
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "dilav"),
            "\\u202edilav");                                             // override
  EXPECT_EQ(printable("\xe2\x81\xa6x\xe2\x81\xa9"), "\\u2066x\\u2069");  // isolate
  EXPECT_EQ(printable("a\xe2\x80\x8b"
                      "b\xef\xbb\xbf"),
            "a\\u200bb\\ufeff");  // zero width
  EXPECT_EQ(printable("a\xe2\x80\xa8"
                      "b\xe2\x80\xa9"),
            "a\\u2028b\\u2029");                            // separators
  EXPECT_EQ(printable("\xf3\xa0\x81\x81"), "\\U000e0041");  // tag
}

TEST(Printable, EscapesBytesThatAreNotUtf8OneByOne) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\\xffb");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xe2\x82\n"), "\\xe2\\x82\\u000a");  // what follows is not swallowed
  EXPECT_EQ(printable("\xe2\x82\xc3\xa9"), "\\xe2\\x82\xc3\xa9");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");           // an overlong newline
  EXPECT_EQ(printable("\x9b"), "\\x9b");
}

TEST(Printable, GivesOneLineOfUtf8ForAnyBytesAndTheSameWhenRepeated) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (std::size_t length = random() % 24; length > 0; --length)
      text +=
          static_cast<char>(random() % (round % 2 == 0 ? 256 : 48) + (round % 2 == 0 ? 0 : 176));
    const std::string out = printable(text);
    for (std::size_t at = 0; at < out.size();) {
      const std::uint32_t point = nextCodePoint(out, at);
      ASSERT_NE(point, kIllFormed);
      ASSERT_FALSE(isControl(point));
      ASSERT_FALSE(point >= 0x2028 && point <= 0x202e);
    }
    ASSERT_EQ(printable(out), out);
  }
}

}  // namespace
}  // namespace lumen::formats
