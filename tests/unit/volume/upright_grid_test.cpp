// SPDX-License-Identifier: Apache-2.0
// Axes that lean, as NRRD, MetaImage and NIfTI state them: one upright grid, and values where they are.
#include "converters/io/volume/upright_grid.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::array kSize = {24, 20, 16};
// edges of a voxel, LPS: the third leans by 15 degrees in y
const Vector3d kRow(0.5, 0, 0), kColumn(0, 0.5, 0), kLean(0, -0.2, 0.75), kOrigin(3, -4, 20);

Vector3d placeOf(int i, int j, int k) {
  return kOrigin + i * kRow + j * kColumn + k * kLean;
}

double smooth(const Vector3d& p) {
  return 500 + 100 * std::sin(p.x() / 2) * std::cos(p.y() / 3) + 20 * (p.z() - 20);
}

std::string voxels() {
  std::vector<float> all;
  for (int k = 0; k < kSize[2]; ++k)
    for (int j = 0; j < kSize[1]; ++j)
      for (int i = 0; i < kSize[0]; ++i)
        all.push_back(static_cast<float>(smooth(placeOf(i, j, k))));
  return bytes(all);
}

class UprightGrid : public FileTest {
protected:
  [[nodiscard]] std::vector<Volume> inEachFormat() const {
    write("v.nrrd",
          "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 20 16\nendian: little\n"
          "encoding: raw\nspace: left-posterior-superior\n"
          "space directions: (0.5,0,0) (0,0.5,0) (0,-0.2,0.75)\n"
          "space origin: (3,-4,20)\n\n" +
              voxels());
    const double length = kLean.norm();
    write("v.mha",
          "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
          "DimSize = 24 20 16\nOffset = 3 -4 20\nElementSpacing = 0.5 0.5 " +
              std::to_string(length) + "\nTransformMatrix = 1 0 0 0 1 0 0 " +
              std::to_string(-0.2 / length) + " " + std::to_string(0.75 / length) +
              "\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n" + voxels());
    MadeNiftiHeader header;
    header.dim = {3, 24, 20, 16, 1, 1, 1, 1};
    header.type = 16;
    header.bits = 32;
    header.pixdim = {1, 0.5F, 0.5F, 0.75F, 1, 1, 1, 1};  // the third: the distance of slices
    std::string nifti = header.text();
    const std::array<float, 12> sform = {-0.5F, 0, 0, -3, 0, -0.5F, 0.2F, 4, 0, 0, 0.75F, 20};
    std::memcpy(nifti.data() + 280, sform.data(), sizeof(sform));
    nifti[123] = 2;  // mm
    write("v.nii", nifti + voxels());
    return {readQuietly(path("v.nrrd")), readQuietly(path("v.mha")), readQuietly(path("v.nii"))};
  }
};

TEST_F(UprightGrid, IsOneForEachFormatAndItsValuesAreWhereTheyWere) {
  for (const Volume& v : inEachFormat()) {
    EXPECT_EQ(v.geometry.size, (std::array{24, 26, 16}));  // 15 steps of 0.2 mm are 6 pixels
    EXPECT_LT((v.geometry.spacing - Vector3d(0.5, 0.5, 0.75)).norm(), 1e-5);
    EXPECT_LT((v.geometry.origin - Vector3d(3, -7, 20)).norm(), 1e-4);
    ASSERT_EQ(v.assumptions.size(), 1U);
    expectRefused(v.assumptions[0], {"lean by 14.9 degrees", "24 x 26 x 16 voxels"});
    ASSERT_TRUE(v.padding);
    const auto& values = std::get<std::vector<float>>(v.voxels);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] <= (*v.padding)[1]) continue;
      ++inside;
      // at the first and the last row there is no voxel beyond for the cubic
      EXPECT_NEAR(values[i], smooth(v.geometry.position(v.geometry.cell(i))), 1.5);
    }
    EXPECT_GE(inside, 24U * 19U * 16U);
    EXPECT_LE(inside, 24U * 20U * 16U);
  }
}

TEST_F(UprightGrid, IsTheFilesOwnWhereNothingLeans) {
  VolumeGeometry geometry;
  geometry.size = {10, 10, 10};
  EXPECT_FALSE(standUpright(geometry));
  geometry.direction(0, 1) = 5e-4;  // no voxel moves by half its size
  EXPECT_FALSE(standUpright(geometry));
  geometry.size = {10, 4000, 10};  // some do
  EXPECT_TRUE(standUpright(geometry));
  geometry = VolumeGeometry();
  geometry.size = {10, 10, 10};
  geometry.direction.col(2) = Vector3d(0.8, 0, 0.6);  // more than 45 degrees
  EXPECT_FALSE(standUpright(geometry));
}

/// Voxels under a lean of 17 degrees: those of a box are `label`, all others `around`.
template <class T>
Volume leaningLabels(T label, T around) {
  Volume volume;
  volume.geometry.size = {6, 6, 6};
  volume.geometry.direction.col(2) = Vector3d(0, 0.3, 1).normalized();
  std::vector<T> voxels;
  for (int i = 0; i < 216; ++i)
    voxels.push_back(i % 6 > 1 && i / 6 % 6 > 1 && i / 36 > 1 ? label : around);
  volume.voxels = voxels;
  const VolumeGeometry stored = volume.geometry;
  EXPECT_TRUE(standUpright(volume.geometry));
  resampleUpright(stored, volume, Progress());
  return volume;
}

TEST_F(UprightGrid, LabelsThatAreNoCleanWholeNumbersStayWhatTheyAre) {
  const Volume below = leaningLabels<std::int16_t>(5, -1);
  for (const std::int16_t voxel : std::get<std::vector<std::int16_t>>(below.voxels))
    EXPECT_TRUE(voxel == 5 || voxel == -1) << voxel;
  const Volume beside = leaningLabels(2.0005F, 0.0F);
  for (const float voxel : std::get<std::vector<float>>(beside.voxels))
    EXPECT_TRUE(voxel == 2.0005F || voxel == 0) << voxel;
  const Volume grey = leaningLabels(2.01F, 0.0F);
  const auto& voxels = std::get<std::vector<float>>(grey.voxels);
  EXPECT_TRUE(
      std::any_of(voxels.begin(), voxels.end(), [](float v) { return v > 0.5 && v < 1.5; }));
}

TEST_F(UprightGrid, WidensATypeThatHasNoValueLeftForPadding) {
  VolumeGeometry stored;
  stored.size = {6, 6, 6};
  stored.direction.col(2) = Vector3d(0, 0.3, 1).normalized();
  Volume volume;
  volume.geometry = stored;
  ASSERT_TRUE(standUpright(volume.geometry));
  std::vector<std::uint8_t> grey;
  for (int i = 0; i < 216; ++i) grey.push_back(static_cast<std::uint8_t>(i * 37 % 200));
  volume.voxels = grey;
  resampleUpright(stored, volume, Progress());
  EXPECT_EQ(volume.padding, (std::array{-1.0F, -1.0F}));
  const auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  EXPECT_EQ(voxels[volume.geometry.index({0, 0, 0})], 0);  // the first slice is as it was
  EXPECT_EQ(voxels[volume.geometry.index({3, 2, 0})], grey[15]);
  EXPECT_EQ(*std::min_element(voxels.begin(), voxels.end()), -1);
}

}  // namespace
}  // namespace lumen::convert
