// SPDX-License-Identifier: Apache-2.0
// A tool is pushed through cases that were made of volumes, as a simulator does it.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/pushed_tool.h"
#include "tests/cli/run_lumen.h"
#include "tests/unit/formats/beads.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

class ToolTest : public CliTest {
protected:
  /// Converts a volume, and pushes a tool to every tip of the case.
  void pushThrough(const std::string& volume, const std::string& seeds) const {
    const Outcome made = lumen({"convert", volume, "case.lumen", "--seeds", seeds, "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json info = Json::parse(lumen({"info", "case.lumen", "--json"}).out);
    const double voxel = info["provenance"]["voxel_size_mm"];
    blob_model* model = nullptr;
    ASSERT_EQ(blob_model_open(path("case.lumen").c_str(), nullptr, &model), BLOB_OK);
    const std::vector<PushedTool> tools = pushToEveryTip(model);
    EXPECT_FALSE(tools.empty());
    for (const std::uint32_t node : firstClosedNodes(model)) {
      const blob_node closed = blob_model_node(model, node);
      ADD_FAILURE() << "closed before node " << node << " of radius " << closed.radius << " at "
                    << closed.centre[0] << ", " << closed.centre[1] << ", " << closed.centre[2];
    }
    for (const PushedTool& tool : tools) {
      const std::string tip =
          "tip " + std::to_string(tool.tip) + " after " + std::to_string(tool.length) +
          " mm, worst near node " + std::to_string(tool.outsideNode) + " at " +
          std::to_string(tool.outsideAt[0]) + ", " + std::to_string(tool.outsideAt[1]) + ", " +
          std::to_string(tool.outsideAt[2]);
      EXPECT_LE(tool.outside, 0.1 * voxel) << tip;
      const double radius = blob_model_node(model, tool.tip).radius;
      EXPECT_LE(tool.fromTip, radius) << tip;
      EXPECT_LE(tool.cursorFromTip, 4 * radius) << tip;
    }
    blob_model_close(model);
  }

  void pushThroughPhantom(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all = {"phantom"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"volume.nrrd", "--seeds", "seeds.json", "--quiet"});
    const Outcome made = lumen(all);
    ASSERT_EQ(made.code, 0) << made.err;
    pushThrough("volume.nrrd", "seeds.json");
  }
};

TEST_F(ToolTest, OfOnePointFindsTheSameWaysClosedAsInfo) {
  // three vessels of radius 1, each with a gap, the second and third hanging on the first
  formats::Case value = formats::test::noBeads();
  const auto withGap = [](float gap, float y) {
    auto places = formats::test::alongX(0, 0.5F, 11, y);
    for (const auto& place : formats::test::alongX(5 + gap, 0.5F, 11, y)) places.push_back(place);
    return places;
  };
  formats::test::addBeads(value, "a", withGap(2.3F, 0), 1);
  formats::test::addBeads(value, "b", withGap(1.9F, 1), 1, 0);    // open
  formats::test::addBeads(value, "c", withGap(2.1F, -1), 1, 20);  // beyond the first
  formats::test::addBeads(value, "d", withGap(3, 9), 1);
  ASSERT_TRUE(formats::writeCaseFile(value, path("gaps.lumen")));
  blob_model* model = nullptr;
  ASSERT_EQ(blob_model_open(path("gaps.lumen").c_str(), nullptr, &model), BLOB_OK);
  std::vector<std::uint32_t> told;
  const Json info = Json::parse(lumen({"info", "gaps.lumen", "--json"}).out);
  for (const Json& closedPath : info["reachable"]["closed"]) told.push_back(closedPath["node"]);
  std::sort(told.begin(), told.end());
  EXPECT_EQ(told, (std::vector<std::uint32_t>{11, 77}));
  EXPECT_EQ(firstClosedNodes(model), told);
  blob_model_close(model);
}

TEST_F(ToolTest, OfTwoHundredPointsArrivesAtEveryTipOfABifurcation) {
  pushThroughPhantom({"bifurcation", "--size", "64"});
}

TEST_F(ToolTest, OfTwoHundredPointsArrivesAtTheEndsOfVesselsThatTouch) {
  pushThroughPhantom({"kissing", "--size", "64"});
}

TEST_F(ToolTest, OfTwoHundredPointsArrivesBeyondAHairpin) {
  pushThroughPhantom({"hairpin", "--size", "64"});
}

TEST_F(ToolTest, OfTwoHundredPointsArrivesAtEveryTipOfAPatient) {
  pushThroughPhantom({"patient", "--size", "128"});
}

TEST_F(ToolTest, OfTwoHundredPointsArrivesAtEveryTipOfARealAngiogram) {
  const std::filesystem::path volume = LUMEN_SHARED_DATA "/aneurism-3dra.nrrd";
  if (!std::filesystem::exists(volume)) GTEST_SKIP() << volume << " is not there";
  pushThrough(volume, LUMEN_TEST_DATA "/aneurism-3dra.seeds.json");
}

}  // namespace lumen::test
