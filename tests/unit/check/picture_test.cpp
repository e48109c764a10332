// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/raster/picture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

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
