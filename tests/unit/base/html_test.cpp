// SPDX-License-Identifier: Apache-2.0
#include "converters/base/html.h"

#include <string>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lumen
