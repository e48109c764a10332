// SPDX-License-Identifier: Apache-2.0
// A case with a motion: info, --time, and commands that change nodes.
#include <cmath>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

/// A straight tube of five nodes, 1 mm apart along x, whose models are balls.
formats::Case tube() {
  formats::Case value;
  value.points.emplace().offset = {0};
  value.models = formats::BlobbyModels{formats::Kernel::Cauchy, 0.2, 0.1, {0}, {}, {}};
  for (int i = 0; i < 5; ++i) {
    const auto x = static_cast<float>(i);
    value.tree.centre.push_back({x, 0, 0});
    value.tree.direction.push_back({1, 0, 0});
    value.tree.radius.push_back(1);
    value.tree.height.push_back(1);
    value.tree.parent.push_back(i - 1);
    value.tree.branch.push_back(0);
    for (int k = 0; k < 8; ++k) {
      const float angle = 0.785398163F * static_cast<float>(k);
      value.points->position.push_back({x, std::cos(angle), std::sin(angle)});
    }
    value.points->offset.push_back(static_cast<std::uint32_t>(8 * (i + 1)));
    value.models->centre.push_back({x, 0, 0});
    value.models->width.push_back(0.62F);
    value.models->offset.push_back(static_cast<std::uint32_t>(i + 1));
  }
  formats::Branch branch;
  branch.label = "tube";
  branch.nodeCount = 5;
  value.tree.branches = {branch};
  value.metadata.voxelSize = 0.25;
  return value;
}

/// The tube, whose last two nodes move by 2 mm along y from 0 s to 1 s.
formats::Case moving() {
  formats::Case value = tube();
  value.motion = formats::Motion{{0, 1}, 1.5, {3, 4}, {}};
  for (const float y : {0.0F, 2.0F})
    for (const float x : {3.0F, 4.0F}) value.motion->pose.push_back({{x, y, 0}, {0, 0, 0, 1}, 1});
  return value;
}

}  // namespace

class MotionTest : public CliTest {
protected:
  void SetUp() override {
    ASSERT_TRUE(formats::writeCaseFile(tube(), path("still.lumen")));
    ASSERT_TRUE(formats::writeCaseFile(moving(), path("moving.lumen")));
  }
  [[nodiscard]] formats::Case caseIn(const std::string& name) const {
    auto value = formats::readCaseFile(path(name));
    EXPECT_TRUE(value) << value.error().text();
    return value ? *std::move(value) : formats::Case{};
  }
};

TEST_F(MotionTest, InfoNamesTimesPeriodNodesDisplacementAndStrain) {
  const Outcome info = lumen({"info", "moving.lumen", "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  const Json motion = Json::parse(info.out)["motion"];
  EXPECT_EQ(motion["times"], 2);
  EXPECT_EQ(motion["period_s"], 1.5);
  EXPECT_EQ(motion["nodes"], 2);
  EXPECT_EQ(motion["displacement_mm"], 2.0);
  EXPECT_EQ(motion["strain"], 2.0);  // of the edge from node 2 to node 3
  EXPECT_TRUE(Json::parse(lumen({"info", "still.lumen", "--json"}).out)["motion"].is_null());
  const Outcome text = lumen({"info", "moving.lumen"});
  EXPECT_NE(text.out.find("2 times from 0 to 1 s, period 1.5 s, 2 moving nodes, displacement up "
                          "to 2.000 mm, strain up to 2.000"),
            std::string::npos)
      << text.out;
}

TEST_F(MotionTest, TimeGivesTheCaseAtThatTime) {
  const Outcome made = lumen({"convert", "moving.lumen", "at.lumen", "--time", "0.25"});
  ASSERT_EQ(made.code, 0) << made.err;
  const formats::Case at = caseIn("at.lumen");
  EXPECT_FALSE(at.motion);
  EXPECT_EQ(at.tree.centre[4].y, 0.5F);
  EXPECT_EQ(at.tree.centre[2].y, 0);
  EXPECT_EQ(at.metadata.steps.back().name, "pose");
  EXPECT_EQ(at.metadata.parentSha256.size(), 64U);
}

TEST_F(MotionTest, TimeIsRefusedForACaseWithoutAMotion) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"convert", "still.lumen", "at.lumen"},
        {"picture", "still.lumen", "at.png"},
        {"measure", "still.lumen"},
        {"export", "steve", "still.lumen", "at"},
        {"report", "still.lumen", "at.html"},
        {"view", "still.lumen", "--html", "at.html"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--time", "0.25"});
    const Outcome refused = lumen(arguments);
    EXPECT_EQ(refused.code, 2) << command.front();
    EXPECT_NE(refused.err.find("--time is for cases with a motion, and still.lumen has none"),
              std::string::npos)
        << refused.err;
  }
  EXPECT_FALSE(exists("at.lumen"));
}

TEST_F(MotionTest, ExportTakesTheCaseAtATimeAsConvertDoes) {
  ASSERT_EQ(lumen({"convert", "moving.lumen", "at.lumen", "--time", "0.5"}).code, 0);
  ASSERT_EQ(lumen({"export", "steve", "at.lumen", "converted"}).code, 0);
  const Outcome made = lumen({"export", "steve", "moving.lumen", "posed", "--time", "0.5"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.err.find("plays no motion"), std::string::npos) << made.err;
  for (const char* const file : {"/vessels.py", "/vessel.obj", "/Paths/tube.pth"})
    EXPECT_EQ(read("posed" + std::string(file)), read("converted" + std::string(file))) << file;
  EXPECT_NE(read("posed/lumen-export.json").find("as they stand at 0.5 s of the motion"),
            std::string::npos);
  EXPECT_NE(read("posed/README.md").find("as they stand at 0.5 s of the motion"),
            std::string::npos);
}

TEST_F(MotionTest, ExportAtRestReportsTheMotionAsALoss) {
  const Outcome made = lumen({"export", "steve", "moving.lumen", "rest"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string loss = "the vessels are at rest: the folder plays no motion of the case";
  EXPECT_NE(made.err.find(loss), std::string::npos) << made.err;
  EXPECT_NE(read("rest/lumen-export.json").find(loss), std::string::npos);
  ASSERT_EQ(lumen({"export", "steve", "still.lumen", "still"}).code, 0);
  EXPECT_EQ(read("rest/vessel.obj"), read("still/vessel.obj"));
}

TEST_F(MotionTest, ReportStatesTheTimeAndMeasuresThere) {
  // a case without models has no pictures, which take the time
  for (const char* const name : {"still.lumen", "moving.lumen"}) {
    formats::Case value = caseIn(name);
    value.models.reset();
    ASSERT_TRUE(formats::writeCaseFile(value, path(name)));
  }
  ASSERT_EQ(lumen({"report", "moving.lumen", "at.html", "--time", "1"}).code, 0);
  ASSERT_EQ(lumen({"report", "moving.lumen", "rest.html"}).code, 0);
  ASSERT_EQ(lumen({"report", "still.lumen", "still.html"}).code, 0);
  const std::string stated = "1 s of the motion of the case";
  EXPECT_NE(read("at.html").find(stated), std::string::npos);
  EXPECT_EQ(read("rest.html").find(stated), std::string::npos);
  const auto measures = [](const std::string& page) {
    const std::size_t from = page.find("id=\"measures\"");
    EXPECT_NE(from, std::string::npos);
    return page.substr(from, page.find("</section>", from) - from);
  };
  EXPECT_EQ(measures(read("rest.html")), measures(read("still.html")));
  EXPECT_NE(measures(read("at.html")), measures(read("rest.html")));
}

TEST_F(MotionTest, AnotherEncodingKeepsTheMotion) {
  ASSERT_EQ(lumen({"convert", "moving.lumen", "moving.lumen.json"}).code, 0);
  EXPECT_EQ(caseIn("moving.lumen.json"), moving());
  ASSERT_EQ(lumen({"convert", "moving.lumen.json", "again.lumen"}).code, 0);
  EXPECT_EQ(read("again.lumen"), read("moving.lumen"));
}

// spec: M53
TEST_F(MotionTest, FitKeepsTheMotionAndTrimThatOfTheNodesThatStay) {
  ASSERT_EQ(lumen({"fit", "moving.lumen", "fitted.lumen"}).code, 0);
  EXPECT_EQ(caseIn("fitted.lumen").motion, moving().motion);
  formats::Case thin = moving();
  thin.tree.radius[4] = 0.1F;
  ASSERT_TRUE(formats::writeCaseFile(thin, path("thin.lumen")));
  const Outcome trimmed = lumen({"trim", "thin.lumen", "trimmed.lumen", "--min-radius", "0.5"});
  ASSERT_EQ(trimmed.code, 0) << trimmed.err;
  const formats::Case left = caseIn("trimmed.lumen");
  ASSERT_TRUE(left.motion);
  EXPECT_EQ(left.motion->node, std::vector<std::uint32_t>{3});
  EXPECT_EQ(left.motion->pose[1].centre.y, 2);
}

TEST_F(MotionTest, SkinIsInAGlbUnlessItIsLeftOut) {
  ASSERT_EQ(lumen({"convert", "moving.lumen", "moving.glb"}).code, 0);
  EXPECT_NE(read("moving.glb").find("\"inverseBindMatrices\""), std::string::npos);
  ASSERT_EQ(lumen({"convert", "moving.lumen", "rest.glb", "--no-skin"}).code, 0);
  ASSERT_EQ(lumen({"convert", "still.lumen", "still.glb"}).code, 0);
  EXPECT_EQ(read("rest.glb"), read("still.glb"));
  EXPECT_EQ(lumen({"convert", "still.lumen", "none.glb", "--no-skin"}).code, 2);
}

TEST_F(MotionTest, AGlbWithASkinIsReadAtRest) {
  ASSERT_EQ(lumen({"convert", "moving.lumen", "moving.glb"}).code, 0);
  ASSERT_EQ(lumen({"convert", "still.lumen", "still.glb"}).code, 0);
  const Json with = Json::parse(lumen({"info", "moving.glb", "--json"}).out);
  const Json without = Json::parse(lumen({"info", "still.glb", "--json"}).out);
  ASSERT_TRUE(with.contains("volume_mm3")) << with;
  EXPECT_NEAR(with["volume_mm3"].get<double>(), without["volume_mm3"].get<double>(), 1e-3);
}

}  // namespace lumen::test
