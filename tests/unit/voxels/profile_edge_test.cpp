// SPDX-License-Identifier: Apache-2.0
// Profiles that a person can draw: a level inside, a level outside, an edge a voxel wide.
#include "converters/voxels/profile_edge.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

constexpr int kProfileSamples = 3 * kSamplesPerVoxel;

/// A profile over six voxels with the wall in the middle: `from` before and `to` behind the place
/// `at` (samples from the wall), and a straight slope of one voxel between.
std::vector<float> slope(double at, double from, double to) {
  std::vector<float> values;
  for (int i = -kProfileSamples; i <= kProfileSamples; ++i) {
    const double share = std::clamp((i - at) / kSamplesPerVoxel + 0.5, 0.0, 1.0);
    values.push_back(static_cast<float>(from + share * (to - from)));
  }
  return values;
}

TEST(ProfileEdge, LiesAtTheHalfLevel) {
  for (const double at : {-12.0, -3.25, 0.0, 0.5, 9.0}) {
    const ProfileEdge edge = findEdge(slope(at, 1100, 100), kProfileSamples);
    EXPECT_EQ(edge.kind, EdgeKind::Falls);
    EXPECT_NEAR(edge.at, at, 1e-3);
    EXPECT_NEAR(edge.steepest, at, 1);
    EXPECT_NEAR(edge.inside, 1100, 1e-3);
    EXPECT_NEAR(edge.outside, 100, 1e-3);
  }
}

TEST(ProfileEdge, IsNoneWhereNothingChanges) {
  EXPECT_EQ(findEdge(slope(0, 500, 500), kProfileSamples).kind, EdgeKind::None);
}

TEST(ProfileEdge, RisesWhereItIsBrighterOutside) {
  const ProfileEdge edge = findEdge(slope(2, 100, 1100), kProfileSamples);
  EXPECT_EQ(edge.kind, EdgeKind::Rises);
  EXPECT_LT(edge.contrast(), -900);
}

// A vessel beside the wall's own, two and a half voxels from its edge.
TEST(ProfileEdge, IsTheFallNearestToTheWall) {
  std::vector<float> values = slope(-4, 1000, 0);
  const std::vector<float> other = slope(16, 0, 1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += other[i];
  const ProfileEdge edge = findEdge(values, kProfileSamples);
  EXPECT_EQ(edge.kind, EdgeKind::Falls);
  EXPECT_NEAR(edge.at, -4, 0.01);
}

// The wall lies in the gap, its own vessel's edge a voxel and a half farther than the other's.
TEST(ProfileEdge, RisesWhereTheOtherVesselIsNearerByMoreThanAVoxel) {
  std::vector<float> values = slope(-16, 1000, 0);
  const std::vector<float> other = slope(4, 0, 1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += other[i];
  EXPECT_EQ(findEdge(values, kProfileSamples).kind, EdgeKind::Rises);
}

TEST(ProfileEdge, TakesTheLevelsBesideItAndNotFromFarAway) {
  std::vector<float> values = slope(0, 1000, 400);
  values.insert(values.end(), 20, 100.0F);
  EXPECT_NEAR(findEdge(values, kProfileSamples).at, 0, 0.01);
}

TEST(ProfileEdge, EndsWhereTheVolumeEnds) {
  std::vector<float> values = slope(0, 1000, 0);
  for (std::size_t i = kProfileSamples + 13; i < values.size(); ++i) values[i] = NAN;
  EXPECT_NEAR(findEdge(values, kProfileSamples).at, 0, 0.01);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = NAN;
  EXPECT_EQ(findEdge(values, kProfileSamples).kind, EdgeKind::None);
}

}  // namespace
}  // namespace lumen::convert
