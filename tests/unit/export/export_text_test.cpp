// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <gtest/gtest.h>

#include "converters/export/shared/text_files.h"

namespace lumen::convert {

TEST(ExportText, ReplacesEachPlaceholderByItsValue) {
  EXPECT_EQ(filled("{a} and {b}, {a}", {{"a", "1"}, {"b", "{c}"}}), "1 and {c}, 1");
}

TEST(ExportText, LeavesOtherBracesAsTheyAre) {
  const char* const text = "{ a; } {} {A} {1} {a1} {a\n} {";
  EXPECT_EQ(filled(text, {}), text);
}

TEST(ExportText, DropsTheLineOfAPlaceholderWhoseValueIsLinesOrNothing) {
  EXPECT_EQ(filled("x\n{a}\ny\n", {{"a", ""}}), "x\ny\n");
  EXPECT_EQ(filled("{a}\ny\n", {{"a", "1\n2\n"}}), "1\n2\ny\n");
  EXPECT_EQ(filled("{a}\ny\n", {{"a", "1"}}), "1\ny\n");
  EXPECT_EQ(filled("x {a}\ny\n", {{"a", ""}}), "x \ny\n");
}

TEST(ExportText, RefusesAPlaceholderWithoutAValueAndAValueWithoutAPlaceholder) {
  EXPECT_THROW(filled("{a}", {}), std::logic_error);
  EXPECT_THROW(filled("{a}", {{"a", "1"}, {"b", "2"}}), std::logic_error);
  EXPECT_THROW(exportText("sofa/README.md"), std::logic_error);
  EXPECT_THROW(exportText("sofa/no such text"), std::logic_error);
}

TEST(ExportText, IsTheFileBesideItsTarget) {
  EXPECT_EQ(exportText("openfoam/turbulenceProperties").substr(0, 8), "FoamFile");
}

}  // namespace lumen::convert
