// SPDX-License-Identifier: Apache-2.0
// A second volume beside the first: it is shown, doubts are stated, and nothing of it enters a case.
#include "served.h"
#include "viewer/session/source_match.h"

namespace lumen::test {

namespace {

/// The tube's volume, moved by that many mm along x.
convert::Volume movedTube(double mm) {
  convert::Volume volume = tubeVolume();
  volume.geometry.origin.x() += mm;
  return volume;
}

/// 8 x 10 x 12 voxels of 1.5 x 1.2 x 1 mm, turned about z by 30 degrees: 0, and then all of one value.
convert::Volume coarseVolume(std::int16_t value) {
  convert::Volume volume;
  volume.geometry.size = {8, 10, 12};
  volume.geometry.spacing = {1.5, 1.2, 1};
  volume.geometry.origin = {3, -1, 0};
  volume.geometry.direction =
      Eigen::AngleAxisd(0.5235987755982988, Eigen::Vector3d::UnitZ()).matrix();
  std::vector<std::int16_t> voxels(std::size_t{8} * 10 * 12, value);
  voxels[0] = 0;
  volume.voxels = std::move(voxels);
  return volume;
}

}  // namespace

TEST(SharedPart, IsThatOfTheSmallerVolume) {
  const convert::VolumeGeometry tube = tubeVolume().geometry;  // 12.8 mm along each axis
  EXPECT_DOUBLE_EQ(viewer::sharedPart(tube, tube), 1);
  EXPECT_NEAR(viewer::sharedPart(tube, movedTube(6.4).geometry), 0.5, 0.05);
  EXPECT_DOUBLE_EQ(viewer::sharedPart(tube, movedTube(13).geometry), 0);
  convert::VolumeGeometry inner = tube;
  inner.size = {10, 10, 10};
  inner.origin = {6, 6, 6};
  EXPECT_DOUBLE_EQ(viewer::sharedPart(tube, inner), 1);
  EXPECT_DOUBLE_EQ(viewer::sharedPart(inner, tube), 1);
}

class SecondVolumeTest : public ServedTest {
protected:
  /// Serves the first volume, beside a case if there is one, and opens the other as the second.
  void serveBoth(const std::vector<std::string>& first, const std::string& second) {
    serve(first);
    Progress silent;
    session->open({path(second), second, viewer::OpenAs::Second}, silent);
  }
  [[nodiscard]] std::string doubt() const {
    const Json said = state()["second"]["doubt"];
    return said.is_string() ? said.get<std::string>() : "";
  }
};

TEST_F(SecondVolumeTest, IsSentWithItsOwnGeometry) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  serve({"tube.nrrd"});
  EXPECT_EQ(get("second").status, 404);
  EXPECT_EQ(state()["second"], nullptr);
  const Json before = state()["revisions"];
  serveBoth({"tube.nrrd"}, "coarse.nrrd");
  EXPECT_EQ(state()["second"]["name"], "coarse.nrrd");
  EXPECT_EQ(state()["second"]["doubt"], nullptr);
  EXPECT_GT(state()["revisions"]["second"], before["second"]);
  const ReadPack pack(get("second").body);
  EXPECT_EQ(pack.json["name"], "coarse.nrrd");
  EXPECT_EQ(pack.json["size"], Json({8, 10, 12}));
  for (const auto& [a, mm] : {std::pair{0, 1.5}, std::pair{1, 1.2}, std::pair{2, 1.0}})
    EXPECT_NEAR(pack.json["spacing_mm"][static_cast<std::size_t>(a)].get<double>(), mm, 1e-12);
  EXPECT_EQ(pack.json["origin"], Json({3.0, -1.0, 0.0}));
  EXPECT_NEAR(pack.json["direction"][0].get<double>(), 0.8660254037844387, 1e-12);
  const auto stored = pack.array<std::uint16_t>("voxel");
  ASSERT_EQ(stored.size(), 960U);
  const double offset = pack.json["offset"];
  EXPECT_EQ(stored[0] + offset, 0);
  for (std::size_t i = 1; i < stored.size(); ++i) ASSERT_EQ(stored[i] + offset, 7);
  EXPECT_EQ(ReadPack(get("volume").body).json["name"], "tube.nrrd");
}

TEST_F(SecondVolumeTest, DoubtsAreStated) {
  writeTube("tube.nrrd");
  writeVolume("apart.nrrd", movedTube(20));
  writeVolume("rim.nrrd", movedTube(11));
  writeVolume("moved.nrrd", movedTube(2));
  serveBoth({"tube.nrrd"}, "apart.nrrd");
  EXPECT_NE(doubt().find("apart.nrrd and tube.nrrd do not overlap"), std::string::npos) << doubt();
  serveBoth({"tube.nrrd"}, "moved.nrrd");
  EXPECT_NE(doubt().find("same voxels as tube.nrrd, at other places"), std::string::npos)
      << doubt();
  convert::Volume rim = movedTube(11);
  std::get<std::vector<std::int16_t>>(rim.voxels)[0] += 1;
  writeVolume("rim.nrrd", rim);
  serveBoth({"tube.nrrd"}, "rim.nrrd");
  EXPECT_NE(doubt().find("only 13 % of rim.nrrd and tube.nrrd overlap"), std::string::npos)
      << doubt();
  serveBoth({"tube.nrrd"}, "tube.nrrd");
  EXPECT_NE(doubt().find("is the same volume"), std::string::npos) << doubt();
}

TEST_F(SecondVolumeTest, ACaseOfTheSecondIsNamed) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  formats::Case value = twoVessels();
  value.metadata.source = convert::describeSource(coarseVolume(7));
  writeCase("two.lumen", value);
  serveBoth({"tube.nrrd", "two.lumen"}, "coarse.nrrd");
  EXPECT_NE(doubt().find("two.lumen was made from coarse.nrrd"), std::string::npos) << doubt();
}

TEST_F(SecondVolumeTest, NothingOfItEntersACase) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  const auto savedCase = [this] {
    EXPECT_EQ(perform({{"op", "seed_add"},
                       {"label", "tube"},
                       {"points", Json::array({{{"position", {6.4, 6.4, 6.4}}}})}})
                  .status,
              200);
    performAll({{"op", "track"}});
    return get("save?format=lumen.json").body;
  };
  serve({"tube.nrrd"});
  const std::string alone = savedCase();
  serveBoth({"tube.nrrd"}, "coarse.nrrd");
  const std::string beside = savedCase();
  EXPECT_FALSE(alone.empty());
  EXPECT_EQ(alone, beside);
}

TEST_F(SecondVolumeTest, GoesWithTheFirstAndComesBackWithUndo) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  serveBoth({"tube.nrrd"}, "coarse.nrrd");
  const Json files = state()["files"];
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[1]["kind"], "second");
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", files[1]["id"]}}).status, 200);
  EXPECT_EQ(state()["second"], nullptr);
  EXPECT_EQ(state()["has_volume"], true);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", files[0]["id"]}}).status, 200);
  EXPECT_EQ(state()["second"], nullptr);
  EXPECT_EQ(state()["files"].size(), 0U);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["second"]["name"], "coarse.nrrd");
}

TEST_F(SecondVolumeTest, IsReadAgainAsTheSecond) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  serveBoth({"tube.nrrd"}, "coarse.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(9));
  performAll({{"op", "reload"}, {"id", state()["files"][1]["id"]}});
  const ReadPack pack(get("second").body);
  EXPECT_EQ(pack.array<std::uint16_t>("voxel")[1] + pack.json["offset"].get<double>(), 9);
  EXPECT_EQ(ReadPack(get("volume").body).json["name"], "tube.nrrd");
}

TEST_F(SecondVolumeTest, CanBeDropped) {
  writeTube("tube.nrrd");
  writeVolume("coarse.nrrd", coarseVolume(7));
  writeCase("two.lumen", twoVessels());
  const auto drop = [this](const std::string& name) {
    std::ifstream file(path(name), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    const auto answer =
        client().Post(root + "file?name=" + name + "&as=second", bytes, "application/octet-stream");
    EXPECT_TRUE(answer);
    waitForJob();
  };
  serve({"tube.nrrd"});
  drop("coarse.nrrd");
  EXPECT_EQ(state()["second"]["name"], "coarse.nrrd");
  drop("two.lumen");  // no volume: refused
  EXPECT_EQ(state()["has_case"], false);
  serve({});
  drop("coarse.nrrd");  // nothing to be seen beside
  EXPECT_EQ(state()["second"], nullptr);
  EXPECT_EQ(state()["has_volume"], false);
}

}  // namespace lumen::test
