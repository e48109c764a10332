// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/nifti_rotation.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

using Eigen::Matrix3f;

constexpr float kRounding = 1e-6F;

/// Rotations by chance, of half a turn or nearly, and every other one mirrored.
Matrix3f axesByChance(std::mt19937& random, int number) {
  std::normal_distribution<float> part;
  Eigen::Quaternionf turn(part(random), part(random), part(random), part(random));
  if (number % 3 == 0) turn.w() = 0;
  if (number % 3 == 1) turn.w() *= 1e-3F;
  if (number % 3 == 2) turn.w() = 2;
  Matrix3f axes = turn.normalized().toRotationMatrix();
  if (number % 2 == 1) axes.col(2) *= -1;
  return axes;
}

TEST(NiftiRotation, AxesAreReadAsTheyAreWritten) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3f axes = axesByChance(random, i);
    const NiftiRotation rotation = niftiRotation(axes);
    EXPECT_EQ(rotation.handedness, i % 2 == 1 ? -1 : 1);
    Matrix3f read = niftiAxes(rotation, {2, 1, 0.5});
    read *= Eigen::Vector3f(0.5F, 1, 2).asDiagonal();
    // near half a turn the quaternion's first part is the square root of a rounding
    const float most = i % 3 == 2 ? 10 * kRounding : 1e-3F;
    ASSERT_LT((read - axes).cwiseAbs().maxCoeff(), most) << i;
  }
}

TEST(NiftiRotation, TheNearestOrthogonalAxesUndoRoundings) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> off(-1e-4F, 1e-4F);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3f axes = axesByChance(random, i);
    Matrix3f skewed = axes;
    for (float& part : skewed.reshaped()) part += off(random);
    const Matrix3f made = orthogonalAxes(skewed);
    ASSERT_LT((made.transpose() * made - Matrix3f::Identity()).cwiseAbs().maxCoeff(), kRounding);
    ASSERT_LT((made - axes).cwiseAbs().maxCoeff(), 3e-4F);
  }
}

// Made by nifti_make_orthog_mat44() and nifti_mat44_to_quatern() of niftiio 3.0.1.
TEST(NiftiRotation, HasTheRoundingsOfTheNiftiLibrary) {
  Matrix3f axes;
  axes << 0.36F, 0.48F, -0.8F, -0.8F, 0.6F, 0.001F, 0.48F, 0.64F, 0.6F;
  Matrix3f orthogonal;
  orthogonal << 0.359680057F, 0.480239987F, -0.799999893F, -0.799999893F, 0.599999964F,
      0.000499994028F, 0.480239987F, 0.63981998F, 0.599999964F;
  EXPECT_EQ(orthogonalAxes(axes), orthogonal);
  const NiftiRotation rotation = niftiRotation(orthogonal);
  EXPECT_EQ(rotation.quaternion, (std::array{0.199799985F, -0.400099963F, -0.400099963F}));
  EXPECT_EQ(rotation.handedness, 1);
}

}  // namespace
}  // namespace lumen::convert
