// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/camera.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "straight_vessels.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// From the middle 30 mm to the patient's left, 20 mm to his back, 10 mm to his head.
formats::Case asymmetric() {
  return test::straightVessels(
      {{{0, 0, 0}, {30, 0, 0}}, {{0, 0, 0}, {0, 20, 0}}, {{0, 0, 0}, {0, 0, 10}}}, 1);
}

Camera cameraOf(const formats::Case& value, View view, double turn = 0, bool allTurns = false) {
  Framing framing;
  framing.view = view;
  framing.turn = turn;
  framing.allTurns = allTurns;
  framing.width = 300;
  framing.height = 200;
  return cameraFor(value.tree, framing);
}

struct Seen {
  View view;
  Vector3d right, up;  ///< LPS
};

class CameraViews : public ::testing::TestWithParam<Seen> {};

// The radiological convention: from in front, and from the feet, the patient's left is on the right.
TEST_P(CameraViews, HaveThePatientTheRightWayRound) {
  const auto& [view, right, up] = GetParam();
  const Camera camera = cameraOf(asymmetric(), view);
  const Vector3d middle = camera.project(Vector3d::Zero());
  const Vector3d atRight = camera.project(10 * right) - middle,
                 above = camera.project(10 * up) - middle;
  EXPECT_NEAR(atRight.x(), 10 * camera.scale, 1e-9);
  EXPECT_NEAR(atRight.y(), 0, 1e-9);
  EXPECT_NEAR(above.y(), -10 * camera.scale, 1e-9);
  EXPECT_NEAR(above.x(), 0, 1e-9);
  EXPECT_NEAR(camera.project(10 * right.cross(up)).z() - middle.z(), 10, 1e-9);
}

const Vector3d kL(1, 0, 0), kP(0, 1, 0), kS(0, 0, 1);
INSTANTIATE_TEST_SUITE_P(All, CameraViews,
                         ::testing::Values(Seen{View::Anterior, kL, kS},
                                           Seen{View::Posterior, -kL, kS}, Seen{View::Left, kP, kS},
                                           Seen{View::Right, -kP, kS},
                                           Seen{View::Superior, -kL, -kP},
                                           Seen{View::Inferior, kL, -kP}));

TEST(Camera, APlaceIsWhereItsPixelIs) {
  const Camera camera = cameraOf(asymmetric(), View::Best, 0.3);
  const Vector3d place(3, -4, 5), seen = camera.project(place);
  EXPECT_LT((camera.place(seen.x(), seen.y(), seen.z()) - place).norm(), 1e-9);
}

TEST(Camera, AQuarterTurnFromTheFrontIsTheLeft) {
  const formats::Case value = asymmetric();
  const Camera turned = cameraOf(value, View::Anterior, std::numbers::pi / 2);
  EXPECT_LT((turned.axes - cameraOf(value, View::Left).axes).norm(), 1e-12);
}

TEST(Camera, AllTurnsShareCentreAndScaleAndHoldEveryNode) {
  const formats::Case value = asymmetric();
  for (const View view : {View::Best, View::Left, View::Superior}) {
    const Camera first = cameraOf(value, view, 0, true);
    for (int frame = 0; frame < 36; ++frame) {
      const Camera camera = cameraOf(value, view, 2 * std::numbers::pi * frame / 36, true);
      EXPECT_EQ(camera.scale, first.scale);
      EXPECT_EQ(camera.centre, first.centre);
      EXPECT_LT((camera.axes.row(1) - first.axes.row(1)).norm(), 1e-12);
      for (std::size_t n = 0; n < value.tree.nodeCount(); ++n) {
        const Vector3d p = camera.project(toEigen(value.tree.centre[n]));
        const double r = camera.scale * double{value.tree.radius[n]};
        ASSERT_GE(std::min(p.x(), p.y()) - r, 0);
        ASSERT_LE(p.x() + r, 300);
        ASSERT_LE(p.y() + r, 200);
      }
    }
  }
}

// The centre of the axis is that of the least circle, not of the box: 15 of the 30 mm to the left.
TEST(Camera, ATurntableWastesLittleRoom) {
  const formats::Case value = test::straightVessels({{{0, 0, 0}, {30, 0, 0}}}, 1);
  const Camera camera = cameraOf(value, View::Anterior, 0, true);
  EXPECT_NEAR(camera.centre.x(), 15, 0.5);
  EXPECT_NEAR(camera.scale, 0.88 * 300 / 32, 0.03 * camera.scale);
}

TEST(Camera, TheBestViewIsAcrossTheVessels) {
  const formats::Case flat =
      test::straightVessels({{{0, 0, 0}, {0, 30, 0}}, {{0, 0, 0}, {0, 10, 20}}}, 1);
  const Vector3d towards = cameraOf(flat, View::Best).axes.row(2);
  EXPECT_NEAR(std::abs(towards.x()), 1, 1e-6);
}

TEST(Camera, OfEquallyGoodViewsTheBestIsFromTheFront) {
  const formats::Case line = test::straightVessels({{{0, 0, 0}, {3, 0, 30}}}, 1);
  const Camera camera = cameraOf(line, View::Best);
  EXPECT_LT((camera.axes.row(2).transpose() + kP).norm(), 1e-3);
  formats::Case point = line;
  point.tree.centre.resize(1);
  point.tree.radius.resize(1);
  EXPECT_LT((cameraOf(point, View::Best).axes.row(2).transpose() + kP).norm(), 1e-3);
  EXPECT_NEAR(cameraOf(point, View::Best).scale, 0.88 * 200 / 2, 1e-6);
}

TEST(Camera, MarksGetTheirRoom) {
  const formats::Case value = test::straightVessels({{{0, 0, 0}, {0, 0, 30}}}, 1);
  Framing framing;
  framing.view = View::Anterior;
  framing.width = 300;
  framing.height = 200;
  framing.margin = 40;
  EXPECT_NEAR(cameraFor(value.tree, framing).scale, 120.0 / 32, 1e-6);
}

}  // namespace
}  // namespace lumen::convert
