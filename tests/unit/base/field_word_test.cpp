// SPDX-License-Identifier: Apache-2.0
#include "converters/base/field_word.h"

#include <gtest/gtest.h>

namespace lumen {
namespace {

TEST(FieldWord, IsTheFieldItselfUnlessItsOwnerHasAnother) {
  const FieldWord plain;
  EXPECT_EQ(plain("spacing"), "spacing");
  EXPECT_EQ(plain("root", 2), "root[2]");
  const FieldWord keyword(
      [](std::string_view field, auto) { return std::string(field).append("="); });
  EXPECT_EQ(keyword("spacing"), "spacing=");
}

}  // namespace
}  // namespace lumen
