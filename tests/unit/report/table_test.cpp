// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "converters/draw/report/report_page.h"

namespace lumen::convert {
namespace {

TEST(ReportTable, ANameInACellIsText) {
  Table table("t", {{"no."}, {"vessel", false}});
  table.row({text("1"), name("<img src=x onerror=alert(1)>")});
  EXPECT_EQ(table.rows(), 1U);
  const std::string html = table.markup().html;
  EXPECT_EQ(html.find("<img"), html.npos);
  EXPECT_NE(html.find("<bdi>&lt;img src=x onerror=alert(1)&gt;</bdi>"), html.npos) << html;
}

TEST(ReportTable, ARowHasACellForEachColumn) {
  Table table("t", {{"a"}, {"b"}, {"c"}});
  table.row({text("1")});
  EXPECT_NE(table.markup().html.find("<tr><td class=\"number\">1</td><td class=\"number\"></td><td "
                                     "class=\"number\"></td></tr>"),
            std::string::npos);
}

}  // namespace
}  // namespace lumen::convert
