// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include <LumenSofa/BlobPose.h>
#include <gtest/gtest.h>
#include <sofa/core/behavior/MechanicalState.h>

#include "scenes.h"

namespace lumensofa::test {
namespace {

using Frames = sofa::core::behavior::MechanicalState<Rigid3>;

struct BlobPose : sofa::testing::BaseSimulationTest {};

std::string repeated(int count, const std::string& before, double step, const std::string& after) {
  std::ostringstream text;
  for (int i = 0; i < count; ++i) text << before << step * i << after << ' ';
  return text.str();
}

/// Frames on each `step`th node of the tube (nodes are 2 mm apart), which nothing holds.
std::string frames(int step) {
  const int count = 30 / step + 1;
  return "<MechanicalObject name='frames' template='Rigid3d' position='" +
         repeated(count, "", 2.0 * step, " 0 0 0 0 0 1") + "'/>" +
         "<BlobField name='wall' filename='" + caseFile("tube.lumen") + "'/>" +
         "<BlobPose name='pose' field='@wall' nodes='" + repeated(count, "", step, "") + "'/>";
}

/// The tube as beams of 800 kPa and a wall of 0.5 mm, in tissue that holds 1 mm of it with `tissue`
/// mN / mm.
std::string softVessel(double tissue) {
  std::ostringstream edges;
  for (int i = 0; i < 15; ++i) edges << i << ' ' << i + 1 << ' ';
  return R"(<Node name="vessel">
    <EulerImplicitSolver rayleighStiffness="0.05" rayleighMass="0"/>
    <BTDLinearSolver/>)" +
         frames(2) + "<MeshTopology name='lines' position='" + repeated(16, "", 4, " 0 0") +
         "' edges='" + edges.str() + R"('/>
    <BeamInterpolation name="interpolation" crossSectionShape="circular" radius="2.5" innerRadius="2"
        defaultYoungModulus="800" defaultPoissonRatio="0.49" straight="0"/>
    <AdaptiveBeamForceFieldAndMass interpolation="@interpolation" massDensity="1.06e-6" computeMass="1"/>
    <RestShapeSpringsForceField name="tissue" stiffness=")" +
         std::to_string(4 * tissue) + "\" angularStiffness=\"" + std::to_string(16 * tissue) +
         R"("/>
    <GenericConstraintCorrection/>
  </Node>)";
}

struct PoseScene {
  explicit PoseScene(const std::string& content) : instance("xml", scene(content)) {
    instance.initScene();
    field = find<BlobField>(instance.root, "vessel");
    pose = find<lumensofa::BlobPose>(instance.root, "vessel");
    vessel = find<Frames>(instance.root, "vessel");
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) instance.simulate(0.01);
  }
  void move(sofa::Size frame, const Vec3& by) {
    auto x = vessel->writePositions();
    x[frame].getCenter() += by;
  }
  [[nodiscard]] double heightOf(std::uint32_t node) const {
    return blob_model_node(field->model(), node).centre[1];
  }
  sofa::testing::BaseSimulationTest::SceneInstance instance;
  BlobField* field;
  lumensofa::BlobPose* pose;
  Frames* vessel;
};

TEST_F(BlobPose, TheWallGoesWithTheFramesAndBetweenThemByTheLengthAlongTheVessel) {
  PoseScene s("<Node name='vessel'>" + frames(10) + "</Node>");  // at the nodes 0, 10, 20, 30
  s.move(1, Vec3(0, 1, 0));
  s.pose->update();
  EXPECT_NEAR(s.heightOf(10), 1, 1e-5);
  EXPECT_NEAR(s.heightOf(13), 0.7, 1e-5);
  EXPECT_NEAR(s.heightOf(20), 0, 1e-5);
  EXPECT_NEAR(s.pose->d_displacement.getValue(), 1, 1e-12);
  // the wall of radius 2 about node 10, at x = 20, stands at 3 above and at -1 below
  int domain = -1;
  sofa::type::Vec3d above(20, 2.9, 0), below(20, -1.1, 0);
  EXPECT_GT(s.field->getValue(above, domain), 0);
  domain = -1;
  EXPECT_LT(s.field->getValue(below, domain), 0);
}

TEST_F(BlobPose, ATreeWithoutFramesRestsAndNodesBeyondTheLastFollowIt) {
  const std::string two =
      "<MechanicalObject template='Rigid3d' position='20 0 0 0 0 0 1  40 0 0 0 0 0 1'/>";
  PoseScene s("<Node name='vessel'>" + two + "<BlobField name='wall' filename='" +
              caseFile("touching.lumen") + "'/><BlobPose field='@wall' nodes='10 20'/></Node>");
  s.move(0, Vec3(0, -0.5, 0));
  s.pose->update();
  EXPECT_NEAR(s.heightOf(0), -0.5, 1e-5);
  EXPECT_NEAR(s.heightOf(15), -0.25, 1e-5);
  EXPECT_NEAR(s.heightOf(30), 0, 1e-5);
  for (std::uint32_t i = 31; i < 62; ++i) EXPECT_NEAR(s.heightOf(i), 3.9, 1e-5);
}

TEST_F(BlobPose, SharesAddUpToOneAndMoveAPointAsTheWallMoves) {
  PoseScene s("<Node name='vessel'>" + frames(5) + "</Node>");
  const Vec3 point(23, 2, 0);
  std::vector<FrameShare> shares;
  s.pose->addShares(point, 11, shares);
  double sum = 0;
  for (const FrameShare& share : shares) sum += share.share;
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_GE(shares.size(), 2U);
  auto to = s.vessel->readPositions().ref();
  const auto from = to;
  for (auto& frame : to) frame.getCenter() += Vec3(0.1, 0.2, 0.3);
  const Vec3 moved = lumensofa::BlobPose::motion(shares.data(), shares.size(), point, from, to);
  EXPECT_LT((moved - Vec3(0.1, 0.2, 0.3)).norm(), 1e-9);
}

// A direction at 20 degrees to the axis, so that the wire meets the wall.
constexpr const char* kSteep = "0 0 0.17365 0.98481";

/// Sum of the tissue's springs on the frames, mN.
Vec3 tissueForce(const PoseScene& s, double tissue) {
  Vec3 sum(0, 0, 0);
  const auto& x = s.vessel->readPositions().ref();
  const auto& rest = s.vessel->readRestPositions().ref();
  for (sofa::Size i = 0; i < x.size(); ++i)
    sum -= (x[i].getCenter() - rest[i].getCenter()) * (4 * tissue);
  return sum;
}

TEST_F(BlobPose, AWireMovesASoftVesselAndStaysInIt) {
  constexpr double kTissue = 0.2;
  PoseScene s(softVessel(kTissue) + wire(kSteep, kContact));
  auto* contact = find<lumensofa::BeamBlobContact>(s.instance.root, "instrument");
  double most = 0;
  for (int step = 0; step < 200; ++step) {
    s.run(1);
    most = std::max(most, contact->d_penetration.getValue());
  }
  EXPECT_LT(most, 0.1);
  EXPECT_GT(s.pose->d_displacement.getValue(), 0.1);
  EXPECT_GT(contact->d_contacts.getValue(), 0U);
  // at rest the springs of the tissue bear the contact forces: what the solver gave the vessel
  s.instance.root->getChild("instrument")->getObject("controller")->findData("speed")->read("0");
  s.run(500);
  const Vec3 tissue = tissueForce(s, kTissue);
  const Vec3 wall = contact->forceOnWall();
  EXPECT_GT(wall.norm(), 1);
  EXPECT_LT((tissue + wall).norm(), 0.01 * wall.norm());
}

TEST_F(BlobPose, InStiffTissueTheWireIsWhereAWallAtRestHoldsIt) {
  PoseScene soft(softVessel(1e7) + wire(kSteep, kContact));
  sofa::testing::BaseSimulationTest::SceneInstance rigid(
      "xml", scene(field("tube.lumen") + wire(kSteep, kContact)));
  rigid.initScene();
  soft.run(150);
  for (int i = 0; i < 150; ++i) rigid.simulate(0.01);
  const auto& a = find<Frames>(soft.instance.root, "instrument")->readPositions().ref();
  const auto& b = find<Frames>(rigid.root, "instrument")->readPositions().ref();
  ASSERT_EQ(a.size(), b.size());
  for (sofa::Size i = 0; i < a.size(); ++i)
    EXPECT_LT((a[i].getCenter() - b[i].getCenter()).norm(), 0.05) << i;
  EXPECT_LT(soft.pose->d_displacement.getValue(), 1e-3);
}

}  // namespace
}  // namespace lumensofa::test
