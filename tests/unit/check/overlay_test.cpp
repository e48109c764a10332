// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "converters/draw/raster/picture.h"

namespace lumen::convert {
namespace {

/// 4 x 5 x 6 voxels of which one is bright.
Volume volumeWith(std::array<int, 3> bright, const Eigen::Matrix3d& direction) {
  Volume volume;
  volume.geometry.size = {4, 5, 6};
  volume.geometry.direction = direction;
  std::vector<std::uint8_t> voxels(4 * 5 * 6);
  voxels[static_cast<std::size_t>((bright[2] * 5 + bright[1]) * 4 + bright[0])] = 200;
  volume.voxels = voxels;
  return volume;
}

/// Where the greatest value of a projection is, and where Panel::pixel() says it is: in voxels.
void expectBrightAt(const Volume& volume, const Panel& panel, const Eigen::Vector3d& index,
                    int across, int down) {
  const Projection image = project(volume, panel, 1);
  const auto brightest = std::max_element(image.values.begin(), image.values.end());
  const auto place = static_cast<int>(brightest - image.values.begin());
  EXPECT_EQ(place % image.width, across) << panel.title;
  EXPECT_EQ(place / image.width, down) << panel.title;
  const auto pixel = panel.pixel(index);
  EXPECT_EQ(static_cast<int>((pixel[0] - panel.x) / panel.right), across) << panel.title;
  EXPECT_EQ(static_cast<int>((pixel[1] - panel.y) / panel.below), down) << panel.title;
}

TEST(Projection, ShowsTheFrontTheSideAndTheFeet) {
  const Volume volume = volumeWith({1, 1, 5}, Eigen::Matrix3d::Identity());
  const Layout layout = layOut(volume.geometry, 0, 0, 0);
  EXPECT_EQ(layout.panels[0].title, "x right, z up");
  EXPECT_EQ(layout.panels[1].title, "y right, z up");
  EXPECT_EQ(layout.panels[2].title, "x right, y down");
  expectBrightAt(volume, layout.panels[0], {1, 1, 5}, 1, 0);
  expectBrightAt(volume, layout.panels[1], {1, 1, 5}, 1, 0);
  expectBrightAt(volume, layout.panels[2], {1, 1, 5}, 1, 1);
}

// The first axis of the grid runs down the patient, the second to the right, the third to the front.
TEST(Projection, GoesByThePatientAndNotByTheGrid) {
  Eigen::Matrix3d direction;
  direction << 0, -1, 0, 0, 0, -1, -1, 0, 0;
  const Volume volume = volumeWith({1, 1, 5}, direction);
  const Layout layout = layOut(volume.geometry, 0, 0, 0);
  // of x 5 voxels, of y 6, of z 4, all against the grid
  expectBrightAt(volume, layout.panels[0], {1, 1, 5}, 3, 1);
  expectBrightAt(volume, layout.panels[1], {1, 1, 5}, 0, 1);
  expectBrightAt(volume, layout.panels[2], {1, 1, 5}, 3, 0);
}

TEST(Projection, ThickSlicesKeepTheirShape) {
  VolumeGeometry geometry;
  geometry.size = {40, 40, 10};
  geometry.spacing = {0.5, 0.5, 2};
  const Layout layout = layOut(geometry, 0, 0, 0);
  EXPECT_EQ(layout.panels[0].width, layout.panels[0].height);
}

constexpr Rgb kBlack{0, 0, 0}, kRed{255, 0, 0};

std::size_t count(const Picture& picture, const Rgb& colour) {
  std::size_t n = 0;
  for (const Rgb& pixel : picture.pixels) n += pixel == colour;
  return n;
}

TEST(Picture, LineHasAPixelForEachStepAndNoneOutside) {
  Picture picture(10, 6, kBlack);
  picture.line(-5, 3.5, 20, 3.5, kRed);
  EXPECT_EQ(count(picture, kRed), 10U);
  EXPECT_EQ(picture.pixels[3 * 10], kRed);
}

TEST(Picture, LineFromNowhereDrawsNothing) {
  Picture picture(10, 6, kBlack);
  picture.line(NAN, 0, 3, 3, kRed);
  picture.line(0, 0, 1e30, 3, kRed);
  EXPECT_EQ(count(picture, kRed), 0U);
}

TEST(Picture, TextGivesWhereItEnds) {
  Picture picture(40, 20, kBlack);
  EXPECT_EQ(picture.text(1, 1, 2, "l?i", kRed), 1 + 3 * 12);
  EXPECT_EQ(count(picture, kRed), 4U * (2 + 1 + 1 + 1 + 1 + 1 + 3 + 1 + 2 + 1 + 1 + 1 + 3));
}

TEST(Picture, PngHasItsSignatureAndSize) {
  const std::string bytes = encodePng(Picture(300, 7, kRed));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(12, 4), "IHDR");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\x01\x2c\0\0\0\x07", 8));
}

}  // namespace
}  // namespace lumen::convert
