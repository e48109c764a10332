// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/marks.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

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

TEST(Marks, SmallPicturesHaveNone) {
  EXPECT_EQ(roomForMarks(159, 800), 0);
  EXPECT_EQ(roomForMarks(800, 159), 0);
  EXPECT_GT(roomForMarks(160, 160), 0);
}

}  // namespace
}  // namespace lumen::convert
