// SPDX-License-Identifier: Apache-2.0
// lumen check, from outside.
#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

class CheckTest : public TubeTest {
protected:
  void SetUp() override {
    TubeTest::SetUp();
    fillOnce("checked tube", [this] {
      make({"convert", "tube.nrrd", "tube.lumen", "--seeds", "seeds.json", "--seeds-only"});
    });
  }
};

/// A case of one branch, without all nodes but the first `count` and without wall points.
Json firstNodes(Json value, std::size_t count) {
  const auto cut = [](Json& list, std::size_t n) {
    list.erase(list.begin() + std::ptrdiff_t(n), list.end());
  };
  for (const char* key :
       {"centre", "direction", "radius", "height", "parent", "branch", "inlierRate"})
    cut(value["tree"][key], count);
  value["tree"]["branches"][0]["nodeCount"] = count;
  value.erase("points");
  Json& models = value["models"];
  cut(models["offset"], count + 1);
  for (const char* key : {"centre", "width"}) cut(models[key], models["offset"].back());
  return value;
}

}  // namespace

TEST_F(CheckTest, ATubeAgreesWithItsVolume) {
  const Outcome checked = lumen({"check", "tube.nrrd", "tube.lumen", "--json"});
  ASSERT_EQ(checked.code, 0) << checked.err;
  const Json answer = Json::parse(checked.out);
  EXPECT_EQ(answer["source"], "same");
  EXPECT_EQ(answer["nodes_outside"], 0);
  EXPECT_LT(answer["wall"]["offset_voxels"]["median_absolute"].get<double>(), 0.15);
  EXPECT_EQ(answer["wall"]["no_edge_share"], 0.0);
  EXPECT_EQ(answer["missing_vessels"].size(), 0U);
  EXPECT_EQ(answer["branches"].size(), 1U);
}

TEST_F(CheckTest, WritesAPictureAndLabels) {
  const Outcome checked =
      lumen({"check", "tube.nrrd", "tube.lumen", "--overlay", "tube.png", "--mask", "mask.nrrd"});
  ASSERT_EQ(checked.code, 0) << checked.err;
  EXPECT_EQ(read("tube.png").substr(0, 4), "\x89PNG");
  const Json volume = Json::parse(lumen({"info", "tube.nrrd", "--json"}).out);
  const Json mask = Json::parse(lumen({"info", "mask.nrrd", "--json", "--voxels"}).out);
  for (const char* key : {"size", "spacing_mm", "origin_mm", "direction"})
    EXPECT_EQ(mask[key], volume[key]) << key;
  EXPECT_EQ(mask["max"], 1.0);
  EXPECT_EQ(mask["pixel_type"], "uint8");
}

TEST_F(CheckTest, HalfOfAVesselTellsThatItGoesOn) {
  ASSERT_EQ(lumen({"convert", "tube.lumen", "tube.lumen.json"}).code, 0);
  const Json whole = Json::parse(read("tube.lumen.json"));
  write("half.lumen.json", firstNodes(whole, whole["tree"]["radius"].size() / 2).dump());
  const Outcome checked = lumen({"check", "tube.nrrd", "half.lumen.json", "--json"});
  ASSERT_EQ(checked.code, 0) << checked.err;
  const Json answer = Json::parse(checked.out);
  EXPECT_NEAR(answer["coverage_share"].get<double>(), 0.5, 0.15);
  EXPECT_EQ(answer["missing_vessels"][0]["at_end"], true);
  EXPECT_EQ(answer["ends"].size(), 2U);
  const Outcome text = lumen({"check", "tube.nrrd", "half.lumen.json"});
  EXPECT_NE(text.out.find(" ends at ("), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("and the vessel goes on for about "), std::string::npos) << text.out;
}

TEST_F(CheckTest, TheCorrectionForBlurCanBeTakenAway) {
  const Json with = Json::parse(lumen({"check", "tube.nrrd", "tube.lumen", "--json"}).out);
  const Json without =
      Json::parse(lumen({"check", "tube.nrrd", "tube.lumen", "--json", "--point-spread", "0"}).out);
  EXPECT_GT(with["point_spread_mm"].get<double>(), 0);
  EXPECT_EQ(without["point_spread_mm"], 0.0);
  EXPECT_EQ(without["wall"]["offset_mm"]["median"],
            with["wall"]["offset_mm"]["median_uncorrected"]);
}

TEST_F(CheckTest, AnotherVolumeIsAWarningAndAnErrorIfStrict) {
  ASSERT_EQ(lumen({"phantom", "tube", "other.nrrd", "--size", "64", "--seed", "2"}).code, 0);
  const Outcome warned = lumen({"check", "other.nrrd", "tube.lumen", "--json"});
  EXPECT_EQ(warned.code, 0);
  EXPECT_NE(warned.err.find("warning: tube.lumen: was made from another volume: other.nrrd has its "
                            "size and place, but other voxels"),
            std::string::npos)
      << warned.err;
  EXPECT_EQ(Json::parse(warned.out)["source"], "other voxels");
  const Outcome strict =
      lumen({"check", "other.nrrd", "tube.lumen", "--strict", "--overlay", "tube.png"});
  EXPECT_EQ(strict.code, 3);
  EXPECT_EQ(strict.out, "");
  EXPECT_FALSE(exists("tube.png"));
}

TEST_F(CheckTest, AVolumeElsewhereIsAnError) {
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tube.lumen", "--mask", "mask.mha"}).code, 0);
  const std::string offset = "Offset = 0 0 0";
  std::string text = read("mask.mha");
  ASSERT_NE(text.find(offset), std::string::npos);
  write("far.mha", text.replace(text.find(offset), offset.size(), "Offset = 999 0 0"));
  const Outcome far = lumen({"check", "far.mha", "tube.lumen"});
  EXPECT_EQ(far.code, 3);
  EXPECT_NE(far.err.find("nodes lies in the volume"), std::string::npos) << far.err;
}

TEST_F(CheckTest, ACaseWithoutModelsIsAnError) {
  const Outcome checked = lumen({"check", "tube.nrrd", "truth.lumen"});
  EXPECT_EQ(checked.code, 3);
  EXPECT_NE(checked.err.find("lumen fit makes them"), std::string::npos) << checked.err;
  EXPECT_EQ(lumen({"check", "tube.lumen", "tube.nrrd"}).code, 4);
}

}  // namespace lumen::test
