// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/surface_size.h"

#include <string>

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"
#include "converters/base/error.h"
#include "converters/stages/surface/closed_surface.h"

namespace lumen::convert {
namespace {

std::string refusalOf(const ClosedSurfaceOptions& options) {
  Progress silent;
  try {
    closedSurface(test::tubeCase(20), options, silent);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "";
}

EdgeLength inMm(double length) {
  return {.share = 0, .minimum = length, .maximum = length};
}

TEST(SurfaceSize, TinyEdgeIsRefusedWithTheNumberOfTrianglesAndOneThatIsEnough) {
  for (const double length : {1e-12, 1e-9, 1e-4}) {
    const std::string text = refusalOf({.edge = inMm(length)});
    EXPECT_NE(text.find(" triangles, which take "), std::string::npos) << text;
    EXPECT_NE(text.find("expected at most 1.7e+07"), std::string::npos) << text;
    const std::string words = ": an edge of ";
    const auto at = text.find(words);
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NE(text.find(" mm or more"), std::string::npos) << text;
    const double enough = std::stod(text.substr(at + words.size()));
    EXPECT_GT(enough, length);
    EXPECT_NO_THROW(requireFewTriangles(test::tubeCase(20).tree, inMm(enough), {}));
  }
}

TEST(SurfaceSize, TinyShareOfTheRadiusIsRefusedWithAShareThatIsEnough) {
  const std::string text = refusalOf({.edge = {.share = 1e-6}});
  EXPECT_NE(text.find("r or more"), std::string::npos) << text;
}

TEST(SurfaceSize, TinyGreatestEdgeIsRefusedInMm) {
  const std::string text = refusalOf({.edge = {.maximum = 1e-6}});
  EXPECT_NE(text.find(" mm or more"), std::string::npos) << text;
}

TEST(SurfaceSize, WallTooThinForItsEdgesIsRefusedWithAThickerOne) {
  const std::string text = refusalOf({.thickness = Length{1e-12, 0}});
  EXPECT_NE(text.find("a thicker wall"), std::string::npos) << text;
}

TEST(SurfaceSize, ExpectsTheTrianglesThatAreMadeWithinAThird) {
  const formats::Case source = test::tubeCase(20);
  Progress silent;
  const ClosedSurface made = closedSurface(source, {}, silent);
  const double expected = expectedTriangles(source.tree, {}, {});
  EXPECT_NEAR(expected / static_cast<double>(made.report.triangles), 1, 0.33);
}

}  // namespace
}  // namespace lumen::convert
