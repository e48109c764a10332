// SPDX-License-Identifier: Apache-2.0
// Changes of every message before it is shown, and suggestions for a slip.
#include <string>

#include <gtest/gtest.h>

#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::test {

TEST(MessageText, AddressesOfObjectsAreLeftOut) {
  EXPECT_EQ(messageText("itk::ERROR: NrrdImageIO(0x55d0c0ffee00): no such key"),
            "itk::ERROR: NrrdImageIO: no such key");
  EXPECT_EQ(messageText("at 0x7ffe12345678 or 0x55D0C0FFEE00"), "at  or ");
}

TEST(MessageText, OtherHexadecimalNumbersStay) {
  EXPECT_EQ(messageText("checksum 0xdeadbeef, tag (0x0008)"), "checksum 0xdeadbeef, tag (0x0008)");
}

TEST(MessageText, ControlCharactersAreEscapedAndLinesStayLines) {
  EXPECT_EQ(messageText("a\x1b[2J\r\nb"), "a\\u001b[2J\\u000d\nb");
}

TEST(Suggestion, ASlipIsAnInsertedDroppedReplacedOrSwappedLetter) {
  const std::vector<std::string> options = {"--seeds", "--series", "--dark", "--step"};
  for (const char* typed : {"--seed", "--seedss", "--sedes", "--saeds", "-seeds", "--SEEDS"})
    EXPECT_EQ(closest(typed, options), "--seeds") << typed;
}

TEST(Suggestion, TheBeginningOfOneNameMeansThatName) {
  EXPECT_EQ(closest("gau", {"cauchy", "gaussian"}), "gaussian");
  EXPECT_EQ(closest("com", {"compare", "completion"}), "");
}

TEST(Suggestion, NothingNearIsNoSuggestion) {
  EXPECT_EQ(closest("polish", {"convert", "track", "fit"}), "");
  EXPECT_EQ(closest("", {"fit"}), "");
  EXPECT_EQ(didYouMean("polish", {"convert"}), "");
  EXPECT_EQ(didYouMean("confert", {"convert"}), "; did you mean convert?");
}

}  // namespace lumen::test
