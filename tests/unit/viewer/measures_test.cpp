// SPDX-License-Identifier: Apache-2.0
// The measures of the open case.
#include "served.h"

namespace lumen::test {

namespace {

formats::Case straightVessel() {
  formats::Case value;
  value.metadata.voxelSize = 0.2;
  addVessel(value, "tube", straightPath({6.4, 6.4, 1.4}, {0, 0, 1}, 11), 1.0, 1.0);
  addModels(value);
  return value;
}

}  // namespace

class MeasuresTest : public ServedTest {
protected:
  void SetUp() override {
    ServedTest::SetUp();
    writeCase("tube.lumen", straightVessel());
    serve({"tube.lumen"});
  }
};

TEST_F(MeasuresTest, AreThoseOfTheCaseUntilItChanges) {
  EXPECT_EQ(state()["revisions"]["measures"], 0);
  EXPECT_EQ(get("measures").status, 404);
  performAll({{"op", "measure"}});
  EXPECT_EQ(state()["revisions"]["measures"], 1);
  EXPECT_EQ(state()["measuresAreOld"], false);
  const Json tables = Json::parse(get("measures").body);
  ASSERT_EQ(tables["vessels"].size(), 1U);
  EXPECT_EQ(tables["vessels"][0]["vessel"], "tube");
  EXPECT_NEAR(tables["vessels"][0]["length_mm"]["value"].get<double>(), 10, 0.01);
  performAll({{"op", "rename"}, {"branch", 0}, {"label", "carotid"}});
  EXPECT_EQ(state()["measuresAreOld"], true);
}

TEST_F(MeasuresTest, AreTablesOfCommaSeparatedValuesToo) {
  performAll({{"op", "measure"}});
  const std::string table = get("measures?kind=vessels").body;
  EXPECT_EQ(table.substr(0, 12), "case,vessel,") << table;
  EXPECT_NE(table.find("\ntube.lumen,tube,"), std::string::npos) << table;
  EXPECT_EQ(get("measures?kind=none").status, 404);
}

}  // namespace lumen::test
