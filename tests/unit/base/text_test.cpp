// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/xml_text.h"
#include "formats/view/text_rules.h"

namespace lumen {
namespace {

TEST(Html, NoCharacterOfATextIsMarkup) {
  EXPECT_EQ(htmlText("<script>alert('1' && \"2\")</script>"),
            "&lt;script&gt;alert(&#39;1&#39; &amp;&amp; &quot;2&quot;)&lt;/script&gt;");
}

TEST(Html, ATextThatIsEscapedAlreadyIsEscapedAgain) {
  EXPECT_EQ(htmlText("&lt;"), "&amp;lt;");
}

TEST(Html, PlainTextOfAnyScriptStays) {
  EXPECT_EQ(htmlText("A. cerebri média ثابت 大脳"), "A. cerebri média ثابت 大脳");
}

TEST(Html, WhatDoesNotShowIsWrittenOut) {
  EXPECT_EQ(htmlText(std::string("a\0b\nc\x7f", 6)), "a\\u0000b\\u000ac\\u007f");
  EXPECT_EQ(htmlText("a\u202eb"), "a\\u202eb");
  EXPECT_EQ(htmlText("a\xff<"), "a\\xff&lt;");
}

TEST(Html, ANameIsAnElementOfItsOwnDirection) {
  EXPECT_EQ(htmlName("a<b"), "<bdi>a&lt;b</bdi>");
}

TEST(Html, AnAddressHoldsItsBytes) {
  EXPECT_EQ(dataAddress("image/png", "foob"), "data:image/png;base64,Zm9vYg==");
  EXPECT_EQ(dataAddress("text/plain", ""), "data:text/plain;base64,");
}

TEST(Html, ALongTextIsCutBetweenCharacters) {
  EXPECT_EQ(shortened("ääää", 100).html, "<bdi>ääää</bdi>");
  EXPECT_EQ(shortened("ääää", 5).html, "<bdi>ää</bdi> … (8 bytes)");
  EXPECT_EQ(shortened(std::string(100000, '<'), 10).html.size(),
            std::string("<bdi></bdi> … (100000 bytes)").size() + 9 * 4);
}

TEST(Html, AltTextsAreEscaped) {
  const std::string html = pngFigure("x", text("a"), "\"><script>").html;
  EXPECT_EQ(html.find("<script>"), html.npos) << html;
}

TEST(Html, AddressesAndScriptsTakeAnyText) {
  EXPECT_EQ(urlAddress("a+b/c d\"<é"), "a%2Bb/c%20d%22%3C%C3%A9");
  EXPECT_EQ(jsonInScript("[\"</script>&\xE2\x80\xA8\xE2\x80\xA9\"]"),
            "[\"\\u003c/script\\u003e\\u0026\\u2028\\u2029\"]");
}

TEST(Html, ATitleOfAPageIsText) {
  PageHead head;
  head.title = "</title>";
  EXPECT_NE(htmlPage(head, "").find("<title>&lt;/title&gt;</title>"), std::string::npos);
}

TEST(NumberText, FiguresHaveTheDigitsThatMatter) {
  EXPECT_EQ(shownFigure(3614.2), "3614");
  EXPECT_EQ(shownFigure(61.24), "61.2");
  EXPECT_EQ(shownFigure(0.519), "0.52");
  EXPECT_EQ(shownFigure(NAN), "?");
  EXPECT_EQ(shownBytes(1), "1 byte");
  EXPECT_EQ(shownBytes(999), "999 bytes");
  EXPECT_EQ(shownBytes(1000), "1.0 kB");
  EXPECT_EQ(shownBytes(16433984), "16 MB");
  EXPECT_EQ(shownBytes(999'600), "1.0 MB");
}

TEST(NumberText, TheGreatestNumberHasAllItsDigits) {
  EXPECT_EQ(fixedText(1.7e308, 2).size(), 309U + 3U);
}

TEST(NumberText, DecimalsHaveNoSignOfNothing) {
  EXPECT_EQ(fixedText(-0.004, 2), "0.00");
  EXPECT_EQ(fixedText(-0.006, 2), "-0.01");
  EXPECT_EQ(fixedText(0, 0), "0");
}

TEST(NumberText, ValuesThatAreMissingOrNotFiniteAreADash) {
  EXPECT_EQ(fixedText({}, 2), "-");
  EXPECT_EQ(fixedText(std::nan(""), 2), "-");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(NumberText, JoinedNumbersAreWholeInFullAndRealWithSixDigits) {
  EXPECT_EQ(joinedNumbers(std::array<int, 2>{1234567, -8}, " x "), "1234567 x -8");
  EXPECT_EQ(joinedNumbers(std::array<double, 3>{1234567, 0.5, -0.0}, ", "), "1.23457e+06, 0.5, 0");
  EXPECT_EQ(joinedNumbers(std::array<double, 0>{}, ", "), "");
}

TEST(NumberText, NumbersThatAMessageRefusesHaveSixDecimalsOrTheirName) {
  EXPECT_EQ(foundNumber(2.5), "2.500000");
  EXPECT_EQ(foundNumber(std::nan("")), "nan");
  EXPECT_EQ(foundNumber(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(NumberText, SignificantDigitsEndWhereTheNumberDoes) {
  EXPECT_EQ(numberText(0.5), "0.5");
  EXPECT_EQ(numberText(1.0 / 3), "0.333333333");
  EXPECT_EQ(numberText(1234567890.0), "1.23456789e+09");
  EXPECT_EQ(numberText(-0.0), "0");
  EXPECT_EQ(shownNumber(1.0 / 3), "0.333333");
  EXPECT_EQ(shownNumber(2e-5, 2), "2e-05");
}

TEST(NumberText, ExactTextsReadBackAsTheSameNumber) {
  EXPECT_EQ(exactText(0.1), "0.1");
  EXPECT_EQ(exactText(1e5), "100000");
  EXPECT_EQ(exactText(0.1 + 0.2), "0.30000000000000004");
}

TEST(NumberText, ShortestTextsReadBackAsTheSameNumber) {
  EXPECT_EQ(formats::shortText(0.1F), "0.1");
  EXPECT_EQ(formats::shortText(1e5F), "1e+05");
  EXPECT_EQ(formats::shortText(-0.0F), "-0");
}

TEST(NumberText, PaddedNumbersAreNeverCut) {
  EXPECT_EQ(paddedNumber(7, 3), "007");
  EXPECT_EQ(paddedNumber(1234, 3), "1234");
}

}  // namespace

TEST(XmlText, EscapesMarkup) {
  EXPECT_EQ(xmlText("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c'");
}

TEST(XmlText, HasNoCharacterThatXmlForbids) {
  EXPECT_EQ(xmlText("a\xef\xbf\xbe-\xef\xbf\xbf-b"), "a_-_-b");
  EXPECT_EQ(xmlText("a\x01\t\nb"), "a___b");
  EXPECT_EQ(xmlText("a\xffz"), "a_z");
  EXPECT_EQ(xmlText("\xed\xa0\x80"), "_");
}

TEST(XmlText, LeavesOtherCharactersAsTheyAre) {
  const char* const text = "ä \xef\xbf\xbd \xf0\x9f\xa9\xb8";
  EXPECT_EQ(xmlText(text), text);
}

TEST(XmlText, HasNoTwoHyphensInAComment) {
  EXPECT_EQ(xmlComment("--- <a>\n\xef\xbf\xbe"), "- - - <a>\n_");
}

}  // namespace lumen
