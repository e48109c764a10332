// SPDX-License-Identifier: Apache-2.0
// Level sets, read by OpenVDB.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include "converters/export/shared/grid_files.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;

class VdbTest : public testing::Test {
protected:
  static constexpr double kBand = 0.6, kSpacing = 0.2;

  std::string encode(const VdbOptions& options) {
    Progress silent;
    return encodeVdb({m_vessels, nullptr, kBand}, m_lattice, options, silent);
  }

  void read(const std::string& bytes) {
    openvdb::initialize();
    std::istringstream in(bytes, std::ios::binary);
    openvdb::io::Stream stream(in, false);
    const auto grids = stream.getGrids();
    ASSERT_EQ(grids->size(), 2U);
    for (const auto& grid : *grids) {
      if (grid->getName() == "distance") m_set = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
      if (grid->getName() == "branch") m_labels = openvdb::gridPtrCast<openvdb::Int32Grid>(grid);
    }
    ASSERT_TRUE(m_set && m_labels);
    m_about = stream.getMetadata();
  }

  const formats::Case m_source = kissingCase(0.5);
  const VesselDistance m_vessels{m_source};
  const Lattice m_lattice = latticeOver(kissingBox(), 0, kSpacing);
  openvdb::FloatGrid::Ptr m_set;
  openvdb::Int32Grid::Ptr m_labels;
  openvdb::MetaMap::Ptr m_about;
};

TEST_F(VdbTest, IsALevelSetInWorldUnits) {
  read(encode({}));
  EXPECT_EQ(m_set->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_TRUE(m_set->transform().isLinear());
  EXPECT_NEAR(m_set->voxelSize().x(), kSpacing, 1e-12);
  EXPECT_FLOAT_EQ(m_set->background(), static_cast<float>(kBand));
  const openvdb::Vec3d first = m_set->indexToWorld(openvdb::Coord(0, 0, 0));
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(first[a], m_lattice.first[a], 1e-9);
  EXPECT_EQ(m_about->metaValue<std::string>("unit"), "mm");
  EXPECT_EQ(m_about->metaValue<std::string>("frame"), "LPS");
}

TEST_F(VdbTest, HoldsEverySampleOfItsBandAndTheSignBeyond) {
  read(encode({}));
  Progress silent;
  const DistanceGrid grid = sampleGrid({m_vessels, nullptr, kBand}, m_lattice, silent);
  const auto voxels = m_set->getConstAccessor();
  const auto labels = m_labels->getConstAccessor();
  std::size_t at = 0, active = 0;
  for (int k = 0; k < m_lattice.size[2]; ++k)
    for (int j = 0; j < m_lattice.size[1]; ++j)
      for (int i = 0; i < m_lattice.size[0]; ++i) {
        const WallDistance expected = grid.values[at++];
        const openvdb::Coord voxel(i, j, k);
        ASSERT_EQ(voxels.getValue(voxel), expected.distance) << i << ' ' << j << ' ' << k;
        ASSERT_EQ(voxels.isValueOn(voxel), std::abs(expected.distance) < static_cast<float>(kBand));
        ASSERT_EQ(labels.getValue(voxel),
                  expected.distance < 0 ? static_cast<int>(expected.branch) + 1 : 0);
        active += voxels.isValueOn(voxel) ? 1U : 0U;
      }
  EXPECT_EQ(m_set->activeVoxelCount(), active);
}

TEST_F(VdbTest, OfHalfFloatsIsSmallerAndRightToTheirPrecision) {
  const std::string whole = encode({}), half = encode({.half = true});
  EXPECT_LT(half.size(), whole.size());
  read(half);
  // 11 bits of a number below 1
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sample(*m_set);
  Progress silent;
  const DistanceGrid grid = sampleGrid({m_vessels}, m_lattice, silent);
  for (double angle = 0; angle < 6; angle += 0.1) {
    const Eigen::Vector3d p{9.3, std::cos(angle), std::sin(angle)};
    EXPECT_NEAR(static_cast<double>(sample.wsSample({p[0], p[1], p[2]})), trilinear(grid, p),
                1.0 / 2048);
  }
}

TEST_F(VdbTest, InMetresScalesDistancesAndPlaces) {
  read(encode({.unit = 1000}));
  EXPECT_NEAR(m_set->voxelSize().x(), kSpacing / 1000, 1e-12);
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sample(*m_set);
  Progress silent;
  const DistanceGrid grid = sampleGrid({m_vessels}, m_lattice, silent);
  EXPECT_NEAR(static_cast<double>(sample.wsSample({0.010, -0.0014, 0})),
              trilinear(grid, {10, -1.4, 0}) / 1000, 1e-9);
}

TEST_F(VdbTest, HasTheSameBytesAgain) {
  EXPECT_EQ(encode({}), encode({}));
}

}  // namespace lumen::test
