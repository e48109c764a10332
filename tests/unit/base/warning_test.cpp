// SPDX-License-Identifier: Apache-2.0
// Lines of warnings: text, places, remedy, code.
#include "converters/base/warning.h"

#include <string>

#include <gtest/gtest.h>

namespace lumen {
namespace {

class LastWarning : public Progress {
public:
  void warn(std::string_view message) override { text = message; }
  std::string text;
};

TEST(Warning, IsALineThatEndsWithItsCode) {
  EXPECT_EQ(warningText({WarningCode::MeshUnit, "a.stl: the unit is guessed"}),
            "a.stl: the unit is guessed [mesh-unit]");
  EXPECT_EQ(warningText({WarningCode::MeshUnit, "it is guessed", "unit states it"}),
            "it is guessed; unit states it [mesh-unit]");
}

TEST(Warning, HasItsFirstThreePlacesAndTheNumberOfTheOthers) {
  Warning warning{WarningCode::LumenContact, "it is cut", "", {{1, 2, 3}}};
  EXPECT_EQ(warningText(warning), "it is cut, at (1.0, 2.0, 3.0) mm [lumen-contact]");
  warning.places.assign(20, {1, 2, 3});
  EXPECT_EQ(warningText(warning),
            "it is cut, at (1.0, 2.0, 3.0), (1.0, 2.0, 3.0), (1.0, 2.0, 3.0) mm and 17 more "
            "[lumen-contact]");
}

TEST(Warning, ReachesItsListenerUnderTheNameOfItsFile) {
  LastWarning heard;
  warn(heard, about("a.lumen", {WarningCode::CaseSeeds, "seeds cannot be read"}));
  EXPECT_EQ(heard.text, "a.lumen: seeds cannot be read [case-seeds]");
}

}  // namespace
}  // namespace lumen
