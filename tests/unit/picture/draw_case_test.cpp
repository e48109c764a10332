// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/draw_case.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/draw/picture/marks.h"
#include "formats/case/vessel_system.h"
#include "straight_vessels.h"

namespace lumen::convert {
namespace {

formats::Case twoVessels() {
  return test::straightVessels({{{0, 0, 0}, {0, 0, 20}}, {{10, 0, 0}, {10, 0, 20}}}, 2);
}

Volume around() {
  Volume volume;
  volume.geometry.size = {20, 12, 26};
  volume.geometry.origin = {-4, -6, -3};
  std::vector<std::uint8_t> voxels(volume.geometry.voxelCount());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::uint8_t>(i * 37 % 251);
  volume.voxels = voxels;
  return volume;
}

PictureOptions small() {
  PictureOptions options;
  options.view = View::Anterior;
  options.width = 200;
  options.height = 160;
  return options;
}

std::string refusal(const formats::Case& value, const PictureOptions& options,
                    const Volume* volume = nullptr) {
  Progress progress;
  try {
    (void)drawCase(value, options, volume, progress);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "";
}

TEST(DrawCase, TellsWhatIsMissing) {
  formats::Case value = twoVessels();
  value.models.reset();
  EXPECT_NE(refusal(value, small()).find("has no models"), std::string::npos);
  formats::Case empty;
  empty.models.emplace();
  EXPECT_NE(refusal(empty, small()).find("has no node"), std::string::npos);
  PictureOptions confidence = small();
  confidence.colour = ColorBy::Confidence;
  EXPECT_NE(refusal(twoVessels(), confidence).find("expected vessel, branch or radius"),
            std::string::npos);
  Volume far = around();
  far.geometry.origin = {1000, 0, 0};
  EXPECT_NE(refusal(twoVessels(), small(), &far).find("lies in the volume"), std::string::npos);
}

TEST(DrawCase, OneNodeIsEnough) {
  formats::Case value = test::straightVessels({{{0, 0, 0}, {0, 0, 2}}}, 2);
  formats::CenterlineTree& tree = value.tree;
  tree.centre.resize(1);
  tree.direction.resize(1);
  tree.radius.resize(1);
  tree.height.resize(1);
  tree.parent.resize(1);
  tree.branch.resize(1);
  tree.branches[0].nodeCount = 1;
  const auto blobs = value.models->offset[1];
  value.models->offset.resize(2);
  value.models->centre.resize(blobs);
  value.models->width.resize(blobs);
  Progress progress;
  const Picture picture = drawCase(value, small(), nullptr, progress);
  const Rgb middle = picture.pixels[80 * 200 + 100];
  EXPECT_GT(middle[0], 2 * middle[1]);
}

TEST(DrawCase, SystemsHaveTheirOwnHuesWithoutAnOption) {
  formats::Case value = twoVessels();
  PictureOptions options = small();
  Progress progress;
  const Picture plain = drawCase(value, options, nullptr, progress);
  options.colour = ColorBy::System;
  EXPECT_NE(refusal(value, options).find("states no system"), std::string::npos);
  std::vector<formats::VesselSystem> systems;
  for (const std::uint32_t branch : value.tree.branch)
    systems.push_back(branch == 0 ? formats::VesselSystem::Artery : formats::VesselSystem::Vein);
  formats::setNodeSystems(value, systems);
  const auto countBlue = [](const Picture& picture) {
    return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                         [](const Rgb& p) { return p[2] > p[0] + 60; });
  };
  const Picture stated = drawCase(value, options, nullptr, progress);
  options.colour = ColorBy::None;
  EXPECT_EQ(drawCase(value, options, nullptr, progress).pixels, stated.pixels);
  EXPECT_EQ(countBlue(plain), 0);
  EXPECT_GT(countBlue(stated), 500);
}

TEST(DrawCase, BranchesHaveTheirOwnHues) {
  PictureOptions options = small();
  options.colour = ColorBy::Branch;
  Progress progress;
  const Picture picture = drawCase(twoVessels(), options, nullptr, progress);
  // orange is red before blue, sky blue is not
  int orange = 0, blue = 0;
  for (const Rgb& p : picture.pixels) {
    orange += p[0] > p[2] + 60;
    blue += p[2] > p[0] + 60;
  }
  EXPECT_GT(orange, 500);
  EXPECT_NEAR(orange, blue, 0.1 * orange);
}

TEST(DrawCase, MarksAreLeftOutOnRequest) {
  PictureOptions options = small();
  options.marks = false;
  Progress progress;
  const auto isBlankAtTheLeft = [](const Picture& picture) {
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < 20; ++x)
        if (picture.pixels[static_cast<std::size_t>(y * picture.width + x)] != Rgb{250, 250, 250})
          return false;
    return true;
  };
  EXPECT_TRUE(isBlankAtTheLeft(drawCase(twoVessels(), options, nullptr, progress)));
  options.marks = true;
  EXPECT_FALSE(isBlankAtTheLeft(drawCase(twoVessels(), options, nullptr, progress)));
}

TEST(DrawCase, AVolumeIsGreyBehindTheVessels) {
  const Volume volume = around();
  Progress progress;
  PictureOptions options = small();
  options.marks = false;
  const Picture plain = drawCase(twoVessels(), options, nullptr, progress);
  const Picture behind = drawCase(twoVessels(), options, &volume, progress);
  std::set<int> greys;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    const Rgb& p = behind.pixels[i];
    if (plain.pixels[i] != Rgb{250, 250, 250}) continue;
    ASSERT_TRUE(p[0] == p[1] && p[1] == p[2]);
    greys.insert(p[0]);
  }
  EXPECT_GT(greys.size(), 20U);
  // within a vessel nothing changes
  EXPECT_EQ(plain.pixels[80 * 200 + 130], behind.pixels[80 * 200 + 130]);
}

TEST(DrawCase, AnyNumberOfThreadsGivesTheSameBytes) {
  const Volume volume = around();
  Progress progress;
  PictureOptions options = small();
  options.turn = 0.3;
  options.colour = ColorBy::Radius;
  const Picture many = drawCase(twoVessels(), options, &volume, progress);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(encodePng(many), encodePng(drawCase(twoVessels(), options, &volume, progress)));
}

constexpr Rgb kPaper{250, 250, 250}, kInk{0, 0, 0};

Camera cameraOf(double scale) {
  Camera camera;
  camera.width = 1000;
  camera.height = 800;
  camera.scale = scale;
  return camera;
}

TEST(Marks, TheBarIsTheLongestRoundLengthInAFifthOfTheWidth) {
  EXPECT_DOUBLE_EQ(makeScaleBar(cameraOf(1)).length, 200);
  EXPECT_DOUBLE_EQ(makeScaleBar(cameraOf(1.01)).length, 100);
  EXPECT_DOUBLE_EQ(makeScaleBar(cameraOf(3.9)).length, 50);
  EXPECT_DOUBLE_EQ(makeScaleBar(cameraOf(300)).length, 0.5);
}

TEST(Marks, TheDrawnBarIsAsLongAsItStates) {
  const Camera camera = cameraOf(3.9);
  Picture picture(camera.width, camera.height, kPaper);
  drawScaleBar(picture, camera, kInk);
  int longest = 0;
  for (int y = 0; y < picture.height; ++y) {
    const auto row = picture.pixels.begin() + std::ptrdiff_t{y} * picture.width;
    longest = std::max(longest, static_cast<int>(std::count(row, row + picture.width, kInk)));
  }
  EXPECT_EQ(longest, static_cast<int>(std::lround(50 * 3.9)));
}

TEST(Marks, SidesAreThoseOfThePatient) {
  EXPECT_EQ(sidesTowards({1, 0, 0}), "L");
  EXPECT_EQ(sidesTowards({-1, 0, 0}), "R");
  EXPECT_EQ(sidesTowards({0, 1, 0}), "P");
  EXPECT_EQ(sidesTowards({0, -1, 0}), "A");
  EXPECT_EQ(sidesTowards({0, 0, 1}), "S");
  EXPECT_EQ(sidesTowards({0, 0, -1}), "I");
  EXPECT_EQ(sidesTowards(Eigen::Vector3d(-0.6, -0.8, 0)), "AR");
  EXPECT_EQ(sidesTowards(Eigen::Vector3d(0.95, 0.312, 0)), "L");
}

// From in front: R at the left edge, L at the right one.
TEST(Marks, SidesStandAtTheirEdges) {
  Camera camera = cameraOf(1);
  camera.axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Picture picture(camera.width, camera.height, kPaper), expected = picture;
  drawSides(picture, camera, kInk);
  expected.text(8, 393, 2, "R", kInk);
  expected.text(1000 - 8 - 10, 393, 2, "L", kInk);
  expected.text(495, 8, 2, "S", kInk);
  expected.text(495, 800 - 8 - 14, 2, "I", kInk);
  EXPECT_EQ(picture.pixels, expected.pixels);
}

TEST(Marks, TheLegendHasItsColoursAndStaysInThePicture) {
  for (const int width : {160, 400, 1000}) {
    const int height = std::max(160, width * 4 / 5);
    Picture picture(width, height, kPaper);
    drawLegend(picture, {"confidence, share", {{255, 0, 0}, {0, 0, 255}}, {"0", "0.5", "1"}}, kInk);
    const auto count = [&](const Rgb& colour) {
      return std::count(picture.pixels.begin(), picture.pixels.end(), colour);
    };
    EXPECT_GT(count({255, 0, 0}), 100);
    EXPECT_LE(std::abs(count({255, 0, 0}) - count({0, 0, 255})), height / 10);
    const int room = roomForMarks(width, height);
    const auto above = picture.pixels.begin() + std::ptrdiff_t{height - room} * width;
    EXPECT_EQ(std::count(picture.pixels.begin(), above, kPaper), above - picture.pixels.begin());
  }
}

// All five systems of vessels, in the width from which they have room.
TEST(Marks, NamesOfColoursOverlapNoOtherMark) {
  for (const int width : {400, 800, 1000}) {
    Camera camera = cameraOf(20);
    camera.width = width;
    const Picture paper(width, width * 4 / 5, kPaper);
    Picture others = paper, legend = paper;
    drawSides(others, camera, kInk);
    drawScaleBar(others, camera, kInk);
    drawLegend(legend,
               {"system",
                {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}},
                {"unknown", "artery", "vein", "true-lumen", "false-lumen"}},
               kInk);
    for (std::size_t i = 0; i < paper.pixels.size(); ++i)
      EXPECT_TRUE(others.pixels[i] == kPaper || legend.pixels[i] == kPaper) << width << " " << i;
    for (unsigned char red = 1; red <= 5; ++red)
      EXPECT_GT(std::count(legend.pixels.begin(), legend.pixels.end(), Rgb{red, 0, 0}), 100);
  }
}

TEST(Marks, SmallPicturesHaveNone) {
  EXPECT_EQ(roomForMarks(159, 800), 0);
  EXPECT_EQ(roomForMarks(800, 159), 0);
  EXPECT_GT(roomForMarks(160, 160), 0);
}

}  // namespace
}  // namespace lumen::convert
