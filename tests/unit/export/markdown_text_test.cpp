// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/export/shared/text_files.h"

namespace lumen::convert {

TEST(MarkdownText, LeavesOrdinaryTextAsItIs) {
  for (const char* const text :
       {"ICA_L", "outlet-ICA_L.2", "A guidewire at (1, 2.5) mm: 3 steps (kg / mm^3).", "Größe"})
    EXPECT_EQ(markdownText(text), text);
}

TEST(MarkdownText, HasNoLinkAndNoPicture) {
  EXPECT_EQ(markdownText("![a](http://b)"), "\\!\\[a\\](http\\://b)");
  EXPECT_EQ(markdownText("<img>"), "\\<img\\>");
  EXPECT_EQ(markdownText("www.b.c"), "www\\.b.c");
}

TEST(MarkdownText, HasNoEmphasisCodeAndCells) {
  EXPECT_EQ(markdownText("_a_ *b* `c` | ~~d~~"), "\\_a\\_ \\*b\\* \\`c\\` \\| \\~\\~d\\~\\~");
  EXPECT_EQ(markdownText("&lt;"), "\\&lt;");
}

TEST(MarkdownText, BeginsNoHeadingAndNoList) {
  EXPECT_EQ(markdownText("# a"), "\\# a");
  EXPECT_EQ(markdownText("- a"), "\\- a");
  EXPECT_EQ(markdownText("12. a"), "12\\. a");
}

TEST(MarkdownText, IsOneLine) {
  EXPECT_EQ(markdownText("a\nb").find('\n'), std::string::npos);
}

}  // namespace lumen::convert
