// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/surface/mend_crossings.h"

namespace lumen::convert {
namespace {

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
