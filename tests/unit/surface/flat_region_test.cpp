// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/flat_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/stages/surface/remesh/mend_crossings.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {
namespace {

Loop2 circle(double radius, int corners, double sign = 1) {
  Loop2 loop;
  for (int i = 0; i < corners; ++i) {
    const double angle = sign * 2 * M_PI * i / corners;
    loop.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return loop;
}

struct Facts {
  double area = 0, leastAngle = 180;
  std::size_t boundaryEdges = 0;
  std::ptrdiff_t euler = 0;
};

Facts measureFacts(const FlatMesh& mesh) {
  Facts facts;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d a = mesh.point[t[(i + 1) % 3]] - mesh.point[t[i]];
      const Eigen::Vector2d b = mesh.point[t[(i + 2) % 3]] - mesh.point[t[i]];
      const double cross = a.x() * b.y() - a.y() * b.x();
      EXPECT_GT(cross, 0);
      facts.area += cross / 6;
      facts.leastAngle = std::min(facts.leastAngle, std::atan2(cross, a.dot(b)) * 180 / M_PI);
      ++edges[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
    }
  for (const auto& entry : edges) {
    EXPECT_LE(entry.second, 2);
    facts.boundaryEdges += entry.second == 1 ? 1 : 0;
  }
  facts.euler = static_cast<std::ptrdiff_t>(mesh.point.size()) -
                static_cast<std::ptrdiff_t>(edges.size()) +
                static_cast<std::ptrdiff_t>(mesh.triangle.size());
  return facts;
}

TEST(TriangulateRegion, AHoleIsSeenPastTheSidesOfWallsAlone) {
  // Four thin walls turn around the middle of a room. All corners of the room lie behind them, and
  // their tips point past the hole.
  const Loop2 room{{-10, -10}, {1.95, -10},  {2, 1},   {2.05, -10}, {10, -10}, {10, 1.95},
                   {-1, 2},    {10, 2.05},   {10, 10}, {-1.95, 10}, {-2, -1},  {-2.05, 10},
                   {-10, 10},  {-10, -1.95}, {1, -2},  {-10, -2.05}};
  const Loop2 hole = circle(0.2, 8, -1);
  const Facts facts = measureFacts(triangulateRegion(room, {hole}, 1));
  EXPECT_NEAR(facts.area, signedArea(room) + signedArea(hole), 1e-9);
  EXPECT_EQ(facts.euler, 0);
}

TEST(TriangulateRegion, OfADiscIsNearlyEquilateral) {
  const Loop2 loop = circle(1, 40);
  const FlatMesh mesh = triangulateRegion(loop, {}, 2 * M_PI / 40);
  const Facts facts = measureFacts(mesh);
  EXPECT_NEAR(facts.area, signedArea(loop), 1e-12);
  EXPECT_EQ(facts.boundaryEdges, 40U);
  EXPECT_EQ(facts.euler, 1);
  EXPECT_GT(facts.leastAngle, 30);
  EXPECT_GT(mesh.point.size(), 150U);  // pi / (0.866 * 0.157^2) = 147, and the rim's 40
}

TEST(TriangulateRegion, FollowsLoopsThatAreNotConvex) {
  Loop2 star;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * M_PI * i / 24, radius = i % 2 == 0 ? 1 : 0.3;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  const Facts facts = measureFacts(triangulateRegion(star, {}, 0.2));
  EXPECT_NEAR(facts.area, signedArea(star), 1e-12);
  EXPECT_EQ(facts.boundaryEdges, 24U);
  EXPECT_EQ(facts.euler, 1);
}

TEST(TriangulateRegion, TakesPointsOnOneLine) {
  const Loop2 square{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const Facts facts = measureFacts(triangulateRegion(square, {}, 10));
  EXPECT_NEAR(facts.area, 4, 1e-12);
  EXPECT_EQ(facts.boundaryEdges, 8U);
}

TEST(TriangulateRegion, LeavesOutHoles) {
  const Loop2 outer = circle(1, 50);
  Loop2 hole = circle(0.6, 30, -1);
  for (Eigen::Vector2d& p : hole) p.x() += 0.25;
  const Facts facts = measureFacts(triangulateRegion(outer, {hole}, 0.125));
  EXPECT_NEAR(facts.area, signedArea(outer) + signedArea(hole), 1e-12);
  EXPECT_EQ(facts.boundaryEdges, 80U);
  EXPECT_EQ(facts.euler, 0);
}

TEST(TriangulateRegion, RefusesLoopsThatCross) {
  EXPECT_TRUE(triangulateRegion({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}, 1).triangle.empty());
  EXPECT_TRUE(triangulateRegion(circle(1, 8, -1), {}, 1).triangle.empty());  // clockwise
  EXPECT_TRUE(triangulateRegion(circle(1, 8), {circle(1.1, 8, -1)}, 1).triangle.empty());
  EXPECT_FALSE(isSimple({{0, 0}, {2, 0}, {1, 0}, {1, 1}}));  // back along itself
  EXPECT_TRUE(isSimple({{0, 0}, {1, 0}, {2, 0}, {1, 1}}));
}

TEST(Length, IsInMillimetresOrRadii) {
  EXPECT_EQ(parseLength("0.5", "--thickness"), (Length{0.5, 0}));
  EXPECT_EQ(parseLength("12mm", "--extend"), (Length{12, 0}));
  EXPECT_EQ(parseLength("0.2r", "--thickness"), (Length{0, 0.2}));
  EXPECT_EQ((Length{1, 2}.at(3)), 7);
  EXPECT_EQ(parseEndLength("5r", "--extend"), (EndLength{"", {0, 5}}));
  EXPECT_EQ(parseEndLength("a=b=5r", "--extend"), (EndLength{"a=b", {0, 5}}));
}

TEST(Length, SaysWhatItFoundAndExpected) {
  for (const char* text :
       {"", "r", "-1r", "0", "nan", "inf", "5 r", "5cm", "1e999", "5rr", "0x5"}) {
    try {
      parseLength(text, "--extend");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      EXPECT_NE(std::string(error.what()).find("--extend: found " + std::string(text)),
                std::string::npos);
    }
  }
  EXPECT_THROW(parseEndLength("=5r", "--extend"), Error);
}

/// For each height a flat triangle, 3 mm from the next, and an upright one beside its corner, whose middle is at that height:
/// both cross where it is less than 0.5 mm.
TriangleMesh pairsAt(const std::vector<double>& heights) {
  TriangleMesh mesh;
  const auto add = [&mesh](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    mesh.position.insert(mesh.position.end(), {a, b, c});
    mesh.triangle.push_back({first, first + 1, first + 2});
  };
  double x = 0;
  for (const double z : heights) {
    add({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
    add({x + 0.2, 0.2, z - 0.5}, {x + 0.2, 0.2, z + 0.5}, {x + 0.3, 2, z});
    x += 3;
  }
  return mesh;
}

/// The crossings of the last mesh, after a search of the others.
std::vector<std::array<std::uint32_t, 2>> foundLast(
    const std::vector<std::vector<double>>& meshes) {
  CrossingSearch search;
  const Progress silent;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (const auto& heights : meshes) pairs = search.find(pairsAt(heights), silent).pairs;
  return pairs;
}

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

TEST(CrossingSearch, FindsACrossingThatIsNew) {
  EXPECT_EQ(foundLast({{0, 5, 5, 5}, {0, 5, 0.2, 5}}), (Pairs{{0, 1}, {4, 5}}));
}

TEST(CrossingSearch, FindsACrossingThatStays) {
  EXPECT_EQ(foundLast({{5, 0, 5}, {5, 0, 4}}), (Pairs{{2, 3}}));
}

TEST(CrossingSearch, FindsNoCrossingThatIsGone) {
  EXPECT_EQ(foundLast({{5, 0, 5}, {5, 4, 5}}), Pairs{});
}

TEST(CrossingSearch, NumbersTrianglesAsTheLastMeshDoes) {
  EXPECT_EQ(foundLast({{5, 5, 0, 5, 5}, {5, 5, 5, 5, 5, 0, 0.1}}), (Pairs{{10, 11}, {12, 13}}));
}

TEST(CrossingSearch, ComparesWithTheFirstMesh) {
  EXPECT_EQ(foundLast({{0, 5, 5}, {5, 5, 5}, {0, 5, 0}}), (Pairs{{0, 1}, {4, 5}}));
}

TEST(CrossingSearch, SearchesAllAfterAMeshWithoutCrossings) {
  EXPECT_EQ(foundLast({{5, 5}, {5, 0}}), (Pairs{{2, 3}}));
}

}  // namespace
}  // namespace lumen::convert
