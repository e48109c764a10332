// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/search.h"

#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "trees.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// A volume in which a tree is bright.
Volume draw(const formats::CenterlineTree& tree) {
  Volume volume;
  volume.geometry.size = {56, 56, 56};
  volume.geometry.spacing = Vector3d::Constant(0.4);
  volume.geometry.origin = {-9, -9, -5};
  const TubeTreeDistance wall(tree);
  std::vector<float> voxels;
  for (std::size_t i = 0; i < volume.geometry.voxelCount(); ++i) {
    const double d = wall.nearest(volume.geometry.position(volume.geometry.cell(i))).distance;
    voxels.push_back(static_cast<float>(1000 / (1 + std::exp(6 * d))));
  }
  volume.voxels = std::move(voxels);
  return volume;
}

struct Scene {
  formats::CenterlineTree rest = test::forkedTree();
  Stations stations = placeStations(rest);
  std::vector<StationShape> shapes;
  std::vector<Vector3d> around;

  Scene() {
    for (const std::uint32_t node : stations.node)
      shapes.push_back(
          {toEigen(rest.centre[node]), toEigen(rest.direction[node]), double{rest.radius[node]}});
    around.assign(stations.size(), Vector3d::Zero());
  }
  [[nodiscard]] SearchResult find(const formats::CenterlineTree& drawn,
                                  const MoveGrid& grid) const {
    const Volume volume = draw(drawn);
    Progress silent;
    return searchMoves(stations, shapes, around, {}, grid, Evidence(volume, false, 0.4), silent);
  }
};

formats::CenterlineTree moved(formats::CenterlineTree tree, const Vector3d& move) {
  for (auto& centre : tree.centre) centre = toVec3f(toEigen(centre) + move);
  return tree;
}

TEST(MotionSearch, FindsATreeThatMovedAsAWhole) {
  const Scene scene;
  const Vector3d move(2, -1, 1);
  const SearchResult found = scene.find(moved(scene.rest, move), {1.0, 3});
  for (std::size_t i = 0; i < scene.stations.size(); ++i) {
    EXPECT_TRUE(found.moves[i].isApprox(move, 1e-9)) << i;
    EXPECT_GT(found.evidence[i], 0.4) << i;
  }
}

TEST(MotionSearch, WithoutEvidenceAStationGoesWithItsNeighbours) {
  const Scene scene;
  formats::CenterlineTree drawn = scene.rest;
  drawn.branches.resize(2);  // one arm is dark
  for (auto* values : {&drawn.radius, &drawn.height}) values->resize(32);
  drawn.centre.resize(32);
  drawn.direction.resize(32);
  drawn.parent.resize(32);
  drawn.branch.resize(32);
  const SearchResult found = scene.find(moved(drawn, {2, 0, 1}), {1.0, 3});
  for (std::size_t i = 0; i < scene.stations.size(); ++i)
    EXPECT_NEAR((found.moves[i] - Vector3d(2, 0, 1)).norm(), 0, 1.1) << i;
}

TEST(MotionSearch, AnEndIsSeenWhereTheVesselEnds) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Volume volume = draw(tree);
  const Evidence evidence(volume, false, 0.4);
  // the trunk's last node is at z = 10, and its round end a radius farther
  const Eigen::Vector3d z = Vector3d::UnitZ();
  const double right = evidence.contrastOfEnd({0, 0, 10}, z, z, 1);
  EXPECT_GT(right, 2 * std::max(0.0, evidence.contrastOfEnd({0, 0, 8.5}, z, z, 1)));
  EXPECT_GT(right, 2 * std::max(0.0, evidence.contrastOfEnd({0, 0, 11.5}, z, z, 1)));
}

TEST(MotionSearch, RefusesAVolumeWithoutVessels) {
  const Scene scene;
  Volume empty = draw(moved(scene.rest, {100, 0, 0}));
  empty.voxels = std::vector<float>(empty.geometry.voxelCount(), 3.0F);
  Progress silent;
  EXPECT_THROW(searchMoves(scene.stations, scene.shapes, scene.around, {}, {1.0, 2},
                           Evidence(empty, false, 0.4), silent),
               Error);
}

TEST(MotionSearch, GridsNameTheirMoves) {
  const MoveGrid grid{0.5, 2};
  EXPECT_EQ(grid.count(), 125U);
  EXPECT_EQ(grid.move(0), Vector3d(-1, -1, -1));
  EXPECT_EQ(grid.move(62), Vector3d::Zero());
  EXPECT_EQ(grid.move(1), Vector3d(-0.5, -1, -1));
  EXPECT_EQ(grid.move(124), Vector3d(1, 1, 1));
}

}  // namespace
}  // namespace lumen::convert
