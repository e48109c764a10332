// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/markup.h"

#include <string>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

TEST(ReportMarkup, ANameInACellIsText) {
  Table table("t", {{"no."}, {"vessel", false}});
  table.row({text("1"), name("<img src=x onerror=alert(1)>")});
  EXPECT_EQ(table.rows(), 1U);
  const std::string html = table.markup().html;
  EXPECT_EQ(html.find("<img"), html.npos);
  EXPECT_NE(html.find("<bdi>&lt;img src=x onerror=alert(1)&gt;</bdi>"), html.npos) << html;
}

TEST(ReportMarkup, ARowHasACellForEachColumn) {
  Table table("t", {{"a"}, {"b"}, {"c"}});
  table.row({text("1")});
  EXPECT_NE(table.markup().html.find("<tr><td class=\"number\">1</td><td class=\"number\"></td><td "
                                     "class=\"number\"></td></tr>"),
            std::string::npos);
}

TEST(ReportMarkup, ALongTextIsCutBetweenCharacters) {
  EXPECT_EQ(shortened("ääää", 100).html, "<bdi>ääää</bdi>");
  EXPECT_EQ(shortened("ääää", 5).html, "<bdi>ää</bdi> … (8 bytes)");
  EXPECT_EQ(shortened(std::string(100000, '<'), 10).html.size(),
            std::string("<bdi></bdi> … (100000 bytes)").size() + 9 * 4);
}

TEST(ReportMarkup, AltTextsAreEscaped) {
  const std::string html = pngFigure("x", text("a"), "\"><script>").html;
  EXPECT_EQ(html.find("<script>"), html.npos) << html;
}

}  // namespace
}  // namespace lumen::convert
