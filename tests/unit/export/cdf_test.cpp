// SPDX-License-Identifier: Apache-2.0
// Files of Discregrid, read by Bullet.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include "converters/export/shared/grid_files.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;

namespace {

/// Distance of Bullet's shape at a place of the file, or nothing.
std::optional<double> ask(btSdfCollisionShape& shape, double x, double y, double z,
                          btVector3* normal = nullptr) {
  btScalar distance = 0;
  btVector3 ignored;
  const btVector3 p(static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z));
  if (!shape.queryPoint(p, distance, normal ? *normal : ignored)) return {};
  return static_cast<double>(distance);
}

std::string fileOf(const VesselDistance& vessels, double spacing, double unit, double band) {
  Progress silent;
  return encodeCdf({vessels, nullptr, band}, latticeOver(kissingBox(), 0, spacing), unit, silent);
}

constexpr double kNoBand = std::numeric_limits<double>::infinity();

}  // namespace

/// A cell's polynomials hold all cubics of one coordinate, so between nodes h/3 apart the error is of fourth order; the
/// same cells with linear interpolation err by h^2/8/rho.
TEST(Cdf, BulletReadsTheFieldBetweenItsNodes) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  const std::string bytes = fileOf(vessels, 0.3, 1, kNoBand);
  btSdfCollisionShape shape;
  ASSERT_TRUE(shape.initializeSDF(bytes.data(), static_cast<int>(bytes.size())));
  double worst = 0;
  for (int k = 0; k < 3000; ++k) {
    const double angle = 0.017 * k, rho = 0.9 + 0.2 * std::fmod(0.37 * k, 1.0);
    const Eigen::Vector3d p{4 + 0.004 * k, rho * std::cos(angle), rho * std::sin(angle)};
    const auto said = ask(shape, p[0], p[1], p[2]);
    ASSERT_TRUE(said);
    worst = std::max(worst, std::abs(*said + static_cast<double>(askAll(vessels, p).distance)));
  }
  EXPECT_LT(worst, 0.3 * 0.3 / 8 / 2) << "half of what linear interpolation may err";
  EXPECT_GT(worst, 0);
}

TEST(Cdf, IsPositiveInTheLumenAndItsNormalPointsThere) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  const std::string bytes = fileOf(vessels, 0.3, 1, kNoBand);
  btSdfCollisionShape shape;
  ASSERT_TRUE(shape.initializeSDF(bytes.data(), static_cast<int>(bytes.size())));
  btVector3 normal;
  EXPECT_GT(*ask(shape, 10.1, 0.02, 0.03), 0.9);
  EXPECT_LT(*ask(shape, 10.1, -1.3, 0.03, &normal), -0.2);
  EXPECT_GT(normal.y(), 0.9);
  // x, y and z are not taken for one another: the narrow vessel lies at y = 2.1, between x = 4 and 15
  EXPECT_GT(*ask(shape, 8, 2.1, 0), 0.5);
  EXPECT_LT(*ask(shape, 1, 2.1, 0), -0.5);
  EXPECT_FALSE(ask(shape, 8, 3.5, 0)) << "outside of the box";
}

TEST(Cdf, InMetresIsAThousandthOfMillimetres) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  const std::string bytes = fileOf(vessels, 0.3, 1000, kNoBand);
  btSdfCollisionShape shape;
  ASSERT_TRUE(shape.initializeSDF(bytes.data(), static_cast<int>(bytes.size())));
  EXPECT_NEAR(*ask(shape, 0.010, 0, 0), 0.001, 0.0001);
}

TEST(Cdf, LeavesOutWhatIsBeyondItsBand) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  const std::string whole = fileOf(vessels, 0.3, 1, kNoBand), banded = fileOf(vessels, 0.3, 1, 0.3);
  EXPECT_LT(banded.size(), whole.size());
  btSdfCollisionShape all, near;
  ASSERT_TRUE(all.initializeSDF(whole.data(), static_cast<int>(whole.size())));
  ASSERT_TRUE(near.initializeSDF(banded.data(), static_cast<int>(banded.size())));
  EXPECT_FALSE(ask(near, 10, 0, 0)) << "in the middle of the lumen";
  for (double y = -1.25; y <= -0.75; y += 0.01) {
    ASSERT_TRUE(ask(near, 10, y, 0)) << y;
    EXPECT_EQ(*ask(near, 10, y, 0), *ask(all, 10, y, 0)) << y;
  }
}

/// A sphere that falls in a vessel comes to rest on its wall; it is Bullet's own engine that asks.
TEST(Cdf, BulletsSphereRestsOnTheWallInTheLumen) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  const std::string bytes = fileOf(vessels, 0.3, 1, 1.2);
  btSdfCollisionShape wall;
  ASSERT_TRUE(wall.initializeSDF(bytes.data(), static_cast<int>(bytes.size())));
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -10, 0});
  const btScalar radius = 0.4F;
  btSphereShape ball(radius);
  btVector3 inertia;
  ball.calculateLocalInertia(1, inertia);
  btDefaultMotionState still, start(btTransform(btQuaternion::getIdentity(), {10, 0.2F, 0}));
  btRigidBody vessel(0, &still, &wall), body(1, &start, &ball, inertia);
  world.addRigidBody(&vessel);
  world.addRigidBody(&body);
  for (int step = 0; step < 600; ++step) world.stepSimulation(1.0F / 120, 0);
  const btVector3 p = body.getWorldTransform().getOrigin();
  const Eigen::Vector3d place{static_cast<double>(p.x()), static_cast<double>(p.y()),
                              static_cast<double>(p.z())};
  EXPECT_LT(place[1], -0.4) << "it fell";
  const double gap = -static_cast<double>(askAll(vessels, place).distance) - 0.4;
  EXPECT_GT(gap, -0.1) << "into the wall";
  EXPECT_LT(gap, 0.1) << "it does not lie on it";
}

}  // namespace lumen::test
