// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"
#include "converters/base/error.h"
#include "converters/stages/surface/closed_surface.h"
#include "converters/stages/surface/remesh_target.h"

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
  return {0, length, length, {}};
}

ClosedSurfaceOptions withEdge(const EdgeLength& edge) {
  ClosedSurfaceOptions options;
  options.edge = edge;
  return options;
}

TEST(SurfaceSize, TinyEdgeIsRefusedWithTheNumberOfTrianglesAndOneThatIsEnough) {
  for (const double length : {1e-12, 1e-9, 1e-4}) {
    const std::string text = refusalOf(withEdge(inMm(length)));
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
  const std::string text = refusalOf(withEdge({1e-6, 0, 1e9, {}}));
  EXPECT_NE(text.find("r or more"), std::string::npos) << text;
}

TEST(SurfaceSize, TinyGreatestEdgeIsRefusedInMm) {
  const std::string text = refusalOf(withEdge({0.25, 0, 1e-6, {}}));
  EXPECT_NE(text.find(" mm or more"), std::string::npos) << text;
}

TEST(SurfaceSize, WallTooThinForItsEdgesIsRefusedWithAThickerOne) {
  ClosedSurfaceOptions options;
  options.thickness = Length{1e-12, 0};
  const std::string text = refusalOf(options);
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
