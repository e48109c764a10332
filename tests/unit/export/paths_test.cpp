// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/paths.h"

#include <gtest/gtest.h>

namespace lumen::convert {

TEST(Paths, HaveNamesOfFilesThatNoProgramTakesForOptions) {
  EXPECT_EQ(fileWord("-rf"), "_rf");
  EXPECT_EQ(fileWord("--Edge"), "_-edge");
  EXPECT_EQ(fileWord("ICA-L"), "ica-l");
}

}  // namespace lumen::convert
