// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include "converters/io/mesh/vertex_streams.h"

namespace lumen::convert {
namespace {

SurfaceMesh withRadii(const std::vector<float>& radii) {
  SurfaceMesh surface;
  surface.radius = radii;
  surface.position.resize(radii.size());
  return surface;
}

/// ITU-R BT.709.
double luminance(const Color& c) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

TEST(VertexColor, GetsLighterWithTheValue) {
  std::vector<float> radii;
  for (int i = 0; i <= 100; ++i) radii.push_back(1 + 0.09F * static_cast<float>(i));
  const SurfaceMesh surface = withRadii(radii);
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  for (std::size_t i = 1; i < colors.size(); ++i)
    EXPECT_GT(luminance(colors[i]), luminance(colors[i - 1])) << i;
}

TEST(VertexColor, OfARadiusGoesWithItsLogarithm) {
  // 1 to 100: 10 lies halfway, where viridis is sRGB 33, 145, 140 (linear light by IEC 61966-2-1)
  const SurfaceMesh surface = withRadii({1, 10, 100});
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  EXPECT_NEAR(colors[1][0], 0.0152 * 65535, 10);
  EXPECT_NEAR(colors[1][1], 0.2832 * 65535, 10);
  EXPECT_NEAR(colors[1][2], 0.2623 * 65535, 10);
}

TEST(VertexColor, OfOneRadiusOnlyIsOneColor) {
  const SurfaceMesh surface = withRadii({2, 2});
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  EXPECT_EQ(colors[0], colors[1]);
}

TEST(VertexColor, SevenBranchesDifferAndTheEighthIsAsTheFirst) {
  SurfaceMesh surface;
  surface.branch = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Branch));
  EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), 7U);
  EXPECT_EQ(colors[7], colors[0]);
}

}  // namespace
}  // namespace lumen::convert
