// SPDX-License-Identifier: Apache-2.0
#include "converters/base/csv_rows.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {
namespace {

/// Rows as "1:[a][b]", with their first lines.
std::string shown(const std::string& text) {
  std::string all;
  for (const CsvRow& row : csvRows(text, "a.csv")) {
    all += std::to_string(row.line) + ":";
    for (const std::string& cell : row.cells) all += "[" + cell + "]";
  }
  return all;
}

TEST(CsvRows, CellsEndAtCommasAndRowsAtAnyLineEnd) {
  EXPECT_EQ(shown("a,b\nc,d\n"), "1:[a][b]2:[c][d]");
  EXPECT_EQ(shown("a,b\r\nc,d"), "1:[a][b]2:[c][d]");
  EXPECT_EQ(shown("a\rb"), "1:[a]1:[b]");
  EXPECT_EQ(shown("a,,\n,"), "1:[a][][]2:[][]");
  EXPECT_EQ(shown(""), "");
}

TEST(CsvRows, EmptyLinesAreNoRows) {
  EXPECT_EQ(shown("\n\na\n\nb\n\n"), "3:[a]5:[b]");
}

TEST(CsvRows, WhiteSpaceAroundCellsIsLeftOut) {
  EXPECT_EQ(shown(" a b ,\t\"c\" \n"), "1:[a b][c]");
}

TEST(CsvRows, QuotedTextsHoldCommasLinesAndQuotes) {
  EXPECT_EQ(shown("\"a,\nb\",\"say \"\"x\"\"\"\nc"), "1:[a,\nb][say \"x\"]3:[c]");
  EXPECT_EQ(shown("\"\""), "1:[]");
}

TEST(CsvRows, OtherQuotesAreRefusedWithTheLine) {
  for (const std::string text : {"a\nb\"c", "a\n\"b\"c", "a\n\"b\" \"", "a\n\"b", "a\n\"b\n\n"})
    try {
      csvRows(text, "a.csv");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      EXPECT_EQ(std::string(error.what()).find("a.csv: line 2: "), 0U) << error.what();
    }
}

}  // namespace
}  // namespace lumen::convert
