// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <LumenSofa/BlobMotion.h>
#include <gtest/gtest.h>

#include "scenes.h"

namespace lumensofa::test {
namespace {

struct BlobMotion : sofa::testing::BaseSimulationTest {
  /// By default the tube that goes 3 mm along y in a second while it shrinks to .9 of its radius of
  /// 2 mm.
  static std::string vessel(const std::string& attributes = {}, const std::string& points = {},
                            const std::string& file = "shifted.lumen") {
    return "<Node name='vessel'>" + points + "<BlobField name='wall' filename='" + caseFile(file) +
           "'/><BlobMotion name='motion' field='@wall' " + attributes + "/></Node>";
  }
};

struct MotionScene {
  explicit MotionScene(const std::string& content) : instance("xml", scene(content)) {
    instance.initScene();
    field = find<BlobField>(instance.root, "vessel");
    motion = find<lumensofa::BlobMotion>(instance.root, "vessel");
  }
  /// mm, along y: the upper wall at x = 30.
  [[nodiscard]] double upperWall() const {
    sofa::type::Vec3d point(30, blob_model_node(field->model(), 15).centre[1] + 1.5, 0);
    field->projectPointonSurface(point, 15);
    return point[1];
  }
  sofa::testing::BaseSimulationTest::SceneInstance instance;
  BlobField* field;
  lumensofa::BlobMotion* motion;
};

TEST_F(BlobMotion, TheWallIsWhereTheMotionOfTheCaseHasIt) {
  MotionScene s(vessel());
  const double rest = s.upperWall();
  EXPECT_NEAR(rest, 2, 0.02);
  for (int i = 0; i < 51; ++i) s.instance.simulate(0.01);
  // a step begins with the wall of its beginning, half a second
  EXPECT_NEAR(s.upperWall(), 1.5 + 0.95 * rest, 1e-3);
  EXPECT_NEAR(s.motion->d_seconds.getValue(), 0.51, 1e-9);
  for (int i = 0; i < 100; ++i) s.instance.simulate(0.01);
  EXPECT_NEAR(s.upperWall(), 3 + 0.9 * rest, 1e-3) << "it stays at its end";
}

TEST_F(BlobMotion, BeginsAtTheTimeThatIsAskedFor) {
  MotionScene s(vessel("offset='0.5'"));
  EXPECT_NEAR(s.upperWall(), 1.5 + 0.95 * 2, 0.02);
}

TEST_F(BlobMotion, AStepOfAnotherLengthIsFollowed) {
  MotionScene s(vessel()), same(vessel());
  for (int i = 0; i < 10; ++i) s.instance.simulate(0.02);
  s.instance.simulate(0.05);
  s.instance.simulate(0.01);
  for (int i = 0; i < 26; ++i) same.instance.simulate(0.01);
  EXPECT_NEAR(s.upperWall(), same.upperWall(), 1e-5);
}

TEST_F(BlobMotion, PointsOfASurfaceGoAlong) {
  const std::string points =
      "<MechanicalObject name='surface' template='Vec3d' position='30 2 0  30 -2 0  10 0 2'/>";
  MotionScene s(vessel("points='@surface'", points));
  for (int i = 0; i < 50; ++i) s.instance.simulate(0.01);
  const auto& x = s.motion->l_points->readPositions().ref();
  EXPECT_LT((x[0] - Vec3(30, 1.5 + 1.9, 0)).norm(), 1e-4);
  EXPECT_LT((x[1] - Vec3(30, 1.5 - 1.9, 0)).norm(), 1e-4);
  EXPECT_NEAR(x[2][1], 1.5, 1e-4);
}

/// A wire that is pushed into a tube that bends, by steps of 0.01 s.
struct BendingTube : MotionScene {
  BendingTube(const std::string& file, const std::string& contactText,
              const std::string& attributes = {})
      : MotionScene(BlobMotion::vessel(attributes, {}, file) + wire("0 0 0 1", contactText)),
        contact(find<BeamBlobContact>(instance.root, "instrument")) {}
  /// Returns how deep the wire was in the wall at most, mm.
  double run(int steps) {
    double most = 0;
    for (int i = 0; i < steps; ++i) {
      instance.simulate(0.01);
      most = std::max(most, contact->d_penetration.getValue());
    }
    return most;
  }
  BeamBlobContact* contact;
};

TEST_F(BlobMotion, AnEntryGoesAlong) {
  MotionScene s(vessel("place='20 1 0 0 0 0 1'"));
  for (int i = 0; i < 50; ++i) s.instance.simulate(0.01);
  const auto& place = s.motion->d_carriedPlace.getValue();
  EXPECT_LT((place.getCenter() - Vec3(20, 1.5 + 0.95, 0)).norm(), 1e-4);
  EXPECT_NEAR(place.getOrientation()[3], 1, 1e-6);
}

TEST_F(BlobMotion, TheWallTakesAWireAlong) {
  BendingTube s("bent.lumen", kContact);
  EXPECT_LT(s.run(300), 0.1);
  EXPECT_GT(s.contact->d_contacts.getValue(), 0U);
  // the wire has come to the tube's end, which is 8 mm above where it was
  const auto* x = s.instance.root->getChild("instrument")->getMechanicalState();
  const sofa::Size tip = x->getSize() - 1;
  EXPECT_GT(x->getPX(tip), 50);
  EXPECT_NEAR(x->getPY(tip), x->getPX(tip) * x->getPX(tip) / 450, 2);
}

TEST_F(BlobMotion, SamplesThatTheWallMayReachInAStepAreHeld) {
  // contacts are looked for .02 mm off, and the wall, which begins when the wire is in and rests,
  // comes up to .7 mm in a step
  std::string contact(kContact);
  const std::string alarm = "alarmDistance='0.5'";
  contact.replace(contact.find(alarm), alarm.size(), "alarmDistance='0.02'");
  BendingTube s("struck.lumen", contact, "offset='-2.5'");
  EXPECT_LT(s.run(250), 0.1);
  EXPECT_LT(s.contact->d_contacts.getValue(), 10U);
  s.instance.root->getChild("instrument")->getObject("controller")->findData("speed")->read("0");
  EXPECT_LT(s.run(1), 0.1);
  EXPECT_GT(s.contact->d_contacts.getValue(), 20U);
  EXPECT_LT(s.run(20), 0.1);
  EXPECT_LT(s.contact->d_contacts.getValue(), 10U) << "the wall rests again";
}

}  // namespace
}  // namespace lumensofa::test
