// SPDX-License-Identifier: Apache-2.0
// Cheapest paths that a person can find.
#include "converters/voxels/search.h"

#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/voxels/cube_search.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// A ring of six, on which the step from 0 to 5 is dear.
template <class Visit>
void onRing(CheapestPaths& paths, std::uint32_t start, const Visit& visit) {
  const auto eachStep = [](std::uint32_t i, const auto& reach) {
    const auto step = [&](std::uint32_t j) {
      return (i == 0 && j == 5) || (i == 5 && j == 0) ? 10.0F : 1.0F;
    };
    for (const std::uint32_t j : {(i + 1) % 6, (i + 5) % 6}) reach(j, [&] { return step(j); });
  };
  paths.run(start, eachStep, visit);
}

const auto kGoOn = [](std::uint32_t, float) { return SearchStep::GoOn; };

std::vector<std::uint32_t> pathTo(const CheapestPaths& paths, std::uint32_t i) {
  return paths.pathTo(i, [](std::uint32_t) { return false; });
}

TEST(CheapestPaths, GoRoundWhatIsDear) {
  CheapestPaths paths(6);
  onRing(paths, 0, kGoOn);
  EXPECT_EQ(pathTo(paths, 5), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(paths.cost(5), 5);
  EXPECT_EQ(paths.before(0), CheapestPaths::kNone);
}

TEST(CheapestPaths, AreVisitedByRisingCost) {
  CheapestPaths paths(6);
  std::vector<float> costs;
  onRing(paths, 1, [&](std::uint32_t, float cost) {
    costs.push_back(cost);
    return SearchStep::GoOn;
  });
  EXPECT_EQ(costs, (std::vector<float>{0, 1, 1, 2, 3, 4}));
}

TEST(CheapestPaths, KeepOutOfBlockedVoxelsAlsoAfterClear) {
  CheapestPaths paths(6);
  paths.block(2);
  for (int search = 0; search < 2; ++search) {
    paths.clear();
    onRing(paths, 0, kGoOn);
    EXPECT_EQ(paths.reached().size(), 5U);
    EXPECT_EQ(pathTo(paths, 3), (std::vector<std::uint32_t>{0, 5, 4, 3}));
  }
}

TEST(CheapestPaths, StopAndGoNoFurtherAreObeyed) {
  CheapestPaths paths(6);
  std::size_t visits = 0;
  onRing(paths, 0, [&](std::uint32_t i, float) {
    ++visits;
    return i == 1 ? SearchStep::GoNoFurther : SearchStep::GoOn;
  });
  EXPECT_EQ(visits, 6U);
  EXPECT_EQ(pathTo(paths, 2), (std::vector<std::uint32_t>{0, 5, 4, 3, 2}));
  paths.clear();
  visits = 0;
  onRing(paths, 0,
         [&](std::uint32_t, float) { return ++visits == 2 ? SearchStep::Stop : SearchStep::GoOn; });
  EXPECT_EQ(visits, 2U);
}

TEST(CheapestPaths, BeginWhereAPathIsToBegin) {
  CheapestPaths paths(6);
  onRing(paths, 0, kGoOn);
  EXPECT_EQ(paths.pathTo(4, [](std::uint32_t i) { return i == 2; }),
            (std::vector<std::uint32_t>{2, 3, 4}));
}

VolumeGeometry gridOf(int edge) {
  VolumeGeometry geometry;
  geometry.size = {edge, edge, edge};
  geometry.spacing = {1, 1, 2};
  return geometry;
}

/// A wall of price 50 at x = 5 with a hole at y = 8.
float wallWithHole(const Cell& cell) {
  return cell.x() == 5 && cell.y() != 8 ? 50.0F : 1.0F;
}

TEST(CubeSearch, GoesThroughTheHoleOfAWall) {
  const VolumeGeometry geometry = gridOf(11);
  const Vector3d start = geometry.worldFromIndex({2, 2, 5});
  CubeSearch search(geometry, start, 20);
  ASSERT_TRUE(search.isPossible());
  const std::size_t goal = search.voxelAt(geometry.worldFromIndex({8, 2, 5}));
  search.run(
      wallWithHole, 50, [](std::size_t, double) { return SearchStep::GoOn; }, Progress());
  const std::vector<Vector3d> path = search.pathTo(goal);
  EXPECT_EQ(path.front(), start);
  EXPECT_EQ(path.back(), geometry.worldFromIndex({8, 2, 5}));
  bool isThroughHole = false;
  for (const Vector3d& p : path) isThroughHole = isThroughHole || (p.x() == 5 && p.y() == 8);
  EXPECT_TRUE(isThroughHole);
}

TEST(CubeSearch, AStepCostsItsLengthByTheMeanPriceOfItsEnds) {
  const VolumeGeometry geometry = gridOf(5);
  CubeSearch search(geometry, geometry.worldFromIndex({1, 1, 1}), 20);
  std::vector<double> cost(search.count(), -1);
  search.run([](const Cell& cell) { return cell.z() == 2 ? 3.0F : 1.0F; },
             CheapestPaths::kInfiniteCost,
             [&](std::size_t voxel, double there) {
               cost[voxel] = there;
               return SearchStep::GoOn;
             },
             Progress());
  const auto at = [&](const Vector3d& index) {
    return cost[search.voxelAt(geometry.worldFromIndex(index))];
  };
  EXPECT_FLOAT_EQ(static_cast<float>(at({2, 1, 1})), 1);
  EXPECT_FLOAT_EQ(static_cast<float>(at({2, 2, 1})), std::sqrt(2.0F));
  EXPECT_FLOAT_EQ(static_cast<float>(at({1, 1, 2})), 4);
  EXPECT_FLOAT_EQ(static_cast<float>(at({1, 1, 3})), 8);
}

TEST(CubeSearch, IsNotPossibleFromOutsideTheVolume) {
  const VolumeGeometry geometry = gridOf(5);
  EXPECT_FALSE(CubeSearch(geometry, {-20, 0, 0}, 3).isPossible());
}

TEST(CubeSearch, KeepsOutOfExcludedBallsButBeginsInThem) {
  const VolumeGeometry geometry = gridOf(11);
  CubeSearch search(geometry, geometry.worldFromIndex({5, 5, 5}), 20);
  for (const std::size_t voxel : search.voxelsIn({geometry.worldFromIndex({5, 5, 5}), 1.1}))
    search.exclude(voxel);
  std::size_t visits = 0;
  search.run([](const Cell&) { return 1.0F; }, CheapestPaths::kInfiniteCost,
             [&](std::size_t, double) {
               ++visits;
               return SearchStep::GoOn;
             },
             Progress());
  EXPECT_EQ(visits, search.count() - 4);  // the neighbours along x and y
}

TEST(CubeSearch, IsCancelled) {
  const VolumeGeometry geometry = gridOf(5);
  CubeSearch search(geometry, geometry.worldFromIndex({1, 1, 1}), 20);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(search.run([](const Cell&) { return 1.0F; }, CheapestPaths::kInfiniteCost,
                          [](std::size_t, double) { return SearchStep::GoOn; }, progress),
               Error);
}

}  // namespace
}  // namespace lumen::convert
