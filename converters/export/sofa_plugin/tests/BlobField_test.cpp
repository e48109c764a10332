// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gtest/gtest.h>

#include "scenes.h"

namespace lumensofa::test {
namespace {

using sofa::type::Mat3x3;
using sofa::type::Vec3d;

struct BlobFieldScene {
  explicit BlobFieldScene(const std::string& file, const std::string& attributes = {})
      : instance("xml", scene(field(file, attributes))) {
    instance.initScene();
    wall = find<BlobField>(instance.root, "vessel");
  }
  sofa::testing::BaseSimulationTest::SceneInstance instance;
  BlobField* wall;
};

struct BlobField : sofa::testing::BaseSimulationTest {};

Vec3d somePoint(std::mt19937& random) {
  std::uniform_real_distribution<double> along(2, 58), across(-3, 3);
  const double x = along(random), y = across(random);
  return {x, y, across(random)};
}

TEST_F(BlobField, GivesWhatLibblobGives) {
  for (const bool local : {false, true}) {
    BlobFieldScene s("tube.lumen", local ? "domain='local'" : "");
    blob_model* model = nullptr;
    ASSERT_EQ(blob_model_open(caseFile("tube.lumen").c_str(), nullptr, &model), BLOB_OK);
    EXPECT_EQ(s.wall->d_nodes.getValue(), 31U);
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
      Vec3d point = somePoint(random), gradient;
      blob_sample sample;
      blob_query(model, local ? BLOB_LOCAL : BLOB_BLENDED, point.data(), nullptr, &sample);
      int domain = -1;
      double value;
      s.wall->getValueAndGradient(point, value, gradient, domain);
      EXPECT_EQ(value, sample.value - blob_model_describe(model).iso_level);
      EXPECT_EQ(domain, static_cast<int>(sample.node));
      EXPECT_EQ(s.wall->getValue(point, domain), value);
      for (sofa::Size k = 0; k < 3; ++k) EXPECT_EQ(gradient[k], sample.gradient[k]);
      EXPECT_EQ(s.wall->getGradient(point, domain), gradient);
    }
    blob_model_close(model);
  }
}

TEST_F(BlobField, IsPositiveInTheLumenAndNegativeInTheWall) {
  BlobFieldScene s("tube.lumen");
  Vec3d axis(30, 0, 0), tissue(30, 0, 2.5);
  EXPECT_GT(s.wall->getValue(axis), 0);
  EXPECT_LT(s.wall->getValue(tissue), 0);
  EXPECT_LT(s.wall->getGradient(tissue)[2], 0);
}

TEST_F(BlobField, GradientAndHessianAreDerivatives) {
  BlobFieldScene s("tube.lumen");
  constexpr double kStep = 1e-3;
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    Vec3d point = somePoint(random);
    int domain = -1;
    const Vec3d gradient = s.wall->getGradient(point, domain);
    Mat3x3 hessian;
    s.wall->getHessian(point, hessian);
    for (sofa::Size k = 0; k < 3; ++k) {
      Vec3d up = point, down = point;
      up[k] += kStep;
      down[k] -= kStep;
      EXPECT_NEAR((s.wall->getValue(up) - s.wall->getValue(down)) / (2 * kStep), gradient[k], 2e-3);
      const Vec3d change = (s.wall->getGradient(up) - s.wall->getGradient(down)) / (2 * kStep);
      for (sofa::Size j = 0; j < 3; ++j) EXPECT_NEAR(change[j], hessian(j, k), 5e-3);
    }
  }
}

TEST_F(BlobField, FindsWhereASegmentCrossesTheWall) {
  BlobFieldScene s("tube.lumen");
  Vec3d axis(30, 0, 0), outside(30, 3, 4), crossing, inside(31, 0.5, 0);
  ASSERT_TRUE(s.wall->computeSegIntersection(axis, outside, crossing));
  EXPECT_NEAR(crossing[1] * crossing[1] + crossing[2] * crossing[2], 4, 0.05);
  EXPECT_NEAR(crossing[1] / crossing[2], 0.75, 1e-6);
  ASSERT_TRUE(s.wall->computeSegIntersection(outside, axis, crossing)) << "inwards";
  EXPECT_FALSE(s.wall->computeSegIntersection(axis, inside, crossing));
}

TEST_F(BlobField, ProjectsPointsOntoTheWall) {
  BlobFieldScene s("tube.lumen");
  for (const double height : {0.5, 1.5, 3.0}) {
    Vec3d point(30, height, 0);
    s.wall->projectPointonSurface(point);
    EXPECT_NEAR(s.wall->getValue(point), 0, 1e-4);
    EXPECT_NEAR(point[1], 2, 0.02);
    EXPECT_NEAR(point[0], 30, 0.05);
  }
}

// Two tubes of radius 2 whose axes are 3.9 apart.
TEST_F(BlobField, APointStaysInItsVesselByItsDomain) {
  BlobFieldScene s("touching.lumen");
  int domain = -1;
  for (int i = 0; i <= 39; ++i) {
    Vec3d point(30, 0.1 * i, 0);
    const double value = s.wall->getValue(point, domain);
    EXPECT_LT(domain, 31) << "left the first vessel at y = " << point[1];
    if (i > 21) {
      EXPECT_LT(value, 0) << "in the wall of its own vessel at y = " << point[1];
    }
  }
  Vec3d other(30, 3.9, 0);
  EXPECT_GT(s.wall->getValue(other), 0) << "a new point there is in the other vessel";
  EXPECT_EQ(s.wall->getDomain(other, 15), s.wall->getDomain(other, domain));
}

TEST_F(BlobField, LooksForNewPointsInItsBranch) {
  BlobFieldScene s("touching.lumen", "branch='b001'");
  Vec3d inFirst(30, 0, 0);
  EXPECT_GE(s.wall->getDomain(inFirst, -1), 31);
  EXPECT_LT(s.wall->getValue(inFirst), 0);
}

TEST_F(BlobField, IsDefinedForPointsThatAreNotFinite) {
  BlobFieldScene s("tube.lumen");
  Vec3d far(1e300, 0, 0), none(std::nan(""), 0, 0);
  EXPECT_LT(s.wall->getValue(far), 0);
  EXPECT_EQ(s.wall->getDomain(none, -1), -1);
  EXPECT_EQ(s.wall->getDomain(none, 7), 7);
}

}  // namespace
}  // namespace lumensofa::test
