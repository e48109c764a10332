// SPDX-License-Identifier: Apache-2.0
#include "converters/base/xml_text.h"

#include <gtest/gtest.h>

namespace lumen {

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
