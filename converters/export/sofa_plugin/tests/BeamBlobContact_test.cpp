// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <sofa/core/behavior/MechanicalState.h>

#include "scenes.h"

namespace lumensofa::test {
namespace {

using State = sofa::core::behavior::MechanicalState<Rigid3>;

struct BeamBlobContact : sofa::testing::BaseSimulationTest {};

struct ContactScene {
  explicit ContactScene(const std::string& content, const std::string& gravity = "0 0 0")
      : instance("xml", scene(content, gravity)) {
    instance.initScene();
    contact = find<lumensofa::BeamBlobContact>(instance.root, "instrument");
    state = find<State>(instance.root, "instrument");
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) instance.simulate(0.01);
  }
  /// mm, of the samples after the last step.
  std::vector<Vec3> positions() {
    std::vector<BeamSample> samples = contact->samples();
    std::vector<Vec3> points;
    placeSamples(*contact->l_interpolation, state->readPositions().ref(), false, samples, points);
    return points;
  }
  /// Greatest distance of the frames from the axis of the tube at y, mm.
  double farthest(double y) {
    double most = 0;
    for (const auto& frame : state->readPositions())
      most = std::max(most, std::hypot(frame.getCenter()[1] - y, frame.getCenter()[2]));
    return most;
  }
  sofa::testing::BaseSimulationTest::SceneInstance instance;
  lumensofa::BeamBlobContact* contact;
  State* state;
};

// The rows of a force on a sample are those that BeamAdapter itself maps it to.
TEST_F(BeamBlobContact, ForcesOnSamplesAreMappedAsByBeamAdapter) {
  ContactScene s(field("tube.lumen") + wire("0 0 0 1", kContact));
  s.run(100);
  auto x = s.state->readPositions().ref();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-0.3, 0.3);
  for (auto& frame : x) {
    for (sofa::Size k = 0; k < 3; ++k) frame.getCenter()[k] += some(random);
    frame.getOrientation() = sofa::type::Quat<double>(some(random), some(random), some(random), 1);
    frame.getOrientation().normalize();
  }
  std::vector<BeamSample> samples;
  std::vector<Vec3> points;
  auto& beams = *s.contact->l_interpolation;
  layOutSamples(beams, 3, 0.2, samples);
  placeSamples(beams, x, true, samples, points);
  ASSERT_EQ(samples.size(), 3 * beams.getNumBeams());
  const Vec3 force(0.3, -0.5, 0.8);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BeamSample& sample = samples[i];
    Vec3 point;
    beams.interpolatePointUsingSpline(sample.beam, sample.share, Vec3(0, 0, 0), x, point);
    EXPECT_LT((point - points[i]).norm(), 1e-9);
    Beams::SpatialVector expected[2];
    beams.MapForceOnNodeUsingSpline(sample.beam, sample.share, Vec3(0, 0, 0), x, force, expected[0],
                                    expected[1]);
    for (int end = 0; end < 2; ++end) {
      EXPECT_LT((expected[end].getForce() - force * sample.weight[end]).norm(), 1e-9);
      EXPECT_LT((expected[end].getTorque() - cross(sample.arm[end], force)).norm(), 1e-9);
    }
  }
}

TEST_F(BeamBlobContact, SamplesLieAtTheEndOfEachBeamAndEvenlyBeforeIt) {
  ContactScene s(field("tube.lumen") + wire("0 0 0 1", kContact));
  s.run(100);  // 21 mm are out: 11 of the body and the tip
  const auto& samples = s.contact->samples();
  ASSERT_EQ(samples.size(), 3 * s.contact->l_interpolation->getNumBeams());
  EXPECT_NEAR(samples.back().abscissa, 70, 1e-6) << "the tip";
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_GT(samples[i].abscissa, samples[i - 1].abscissa);
  EXPECT_EQ(samples.back().radius, 0.2);
}

// A direction at 20 degrees to the axis, so that it meets the wall.
constexpr const char* kOblique = "0 0 0.17365 0.98481";

TEST_F(BeamBlobContact, HoldsAWireInATube) {
  ContactScene s(field("tube.lumen") + wire(kOblique, kContact));
  unsigned most = 0;
  for (int step = 0; step < 200; ++step) {
    s.run(1);
    most = std::max(most, s.contact->d_contacts.getValue());
    ASSERT_LT(s.contact->d_penetration.getValue(), 0.02) << "at step " << step;
    ASSERT_LT(s.farthest(0), 2 - 0.2 + 0.05) << "at step " << step;
  }
  EXPECT_GE(most, 3U);
  EXPECT_GT(s.positions().back()[0], 40) << "and lets it go forward";
}

TEST_F(BeamBlobContact, WithoutItTheWireLeavesTheTube) {
  ContactScene s(wire(kOblique, ""));
  s.run(100);
  EXPECT_GT(s.farthest(0), 2.5);
}

TEST_F(BeamBlobContact, KeepsAWireInItsVesselBesideOneThatTouches) {
  for (const char* domain : {"domain='local'", "domain='blended'"}) {
    ContactScene s(field("touching.lumen", domain) + wire(kOblique, kContact));
    for (int step = 0; step < 200; ++step) {
      s.run(1);
      ASSERT_LT(s.farthest(0), 2 - 0.2 + 0.05) << domain << " at step " << step;
    }
    EXPECT_GT(s.positions().back()[0], 40);
    for (const std::uint32_t cursor : s.contact->cursors()) EXPECT_LT(cursor, 31U);
  }
}

// The cursors of a wire that goes forward are those that its samples would find in a tube alone.
TEST_F(BeamBlobContact, CursorsGoAlongWithTheWire) {
  ContactScene s(field("tube.lumen") + wire(kOblique, kContact));
  for (int step = 0; step < 150; ++step) {
    const auto before = s.positions();
    s.run(1);
    const auto& cursors = s.contact->cursors();
    const auto& samples = s.contact->samples();
    ASSERT_EQ(cursors.size(), samples.size());
    if (before.size() != samples.size()) continue;  // a beam has come out
    const blob_model* model = s.contact->l_field->model();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const blob_node node = blob_model_node(model, cursors[i]);
      ASSERT_LT(std::abs(node.centre[0] - before[i][0]), 2.0)
          << "sample " << i << ", step " << step;
    }
  }
}

TEST_F(BeamBlobContact, TheNearestSamplesAlongTheInstrumentAreFound) {
  const std::vector<double> old{1, 2, 3, 10};
  std::vector<BeamSample> samples(6);
  const double now[] = {0, 1.4, 1.5, 2.9, 7, 12};
  for (std::size_t i = 0; i < 6; ++i) samples[i].abscissa = now[i];
  std::vector<std::size_t> nearest;
  nearestAlong(old, samples, nearest);
  EXPECT_EQ(nearest, (std::vector<std::size_t>{0, 0, 0, 2, 3, 3}));
}

/// A straight beam of 10 mm that rests on the bottom of the tube, with y upwards; nothing holds it.
std::string freeBeam(double friction) {
  return field("tube.lumen") + R"(
  <Node name="instrument">
    <EulerImplicitSolver rayleighStiffness="0" rayleighMass="0"/>
    <BTDLinearSolver/>
    <MeshTopology name="lines" position="20 -1.75 0  22.5 -1.75 0  25 -1.75 0  27.5 -1.75 0  30 -1.75 0"
        edges="0 1  1 2  2 3  3 4"/>
    <MechanicalObject template="Rigid3d" position="20 -1.75 0 0 0 0 1  22.5 -1.75 0 0 0 0 1  25 -1.75 0 0 0 0 1
        27.5 -1.75 0 0 0 0 1  30 -1.75 0 0 0 0 1"/>
    <BeamInterpolation name="interpolation" crossSectionShape="circular" radius="0.2" defaultYoungModulus="1e7"
        defaultPoissonRatio="0.3"/>
    <AdaptiveBeamForceFieldAndMass interpolation="@interpolation" massDensity="6e-6" computeMass="1"/>
    <GenericConstraintCorrection/>
    <BeamBlobContact name="contact" field="@/vessel/wall" interpolation="@interpolation" radius="0.2" samples="3"
        alarmDistance="0.5" friction=")" +
         std::to_string(friction) + R"("/>
  </Node>)";
}

// Coulomb on an incline: with gravity g at an angle to the normal the beam sticks if its tangent is
// below mu, and else slides with the acceleration g (sin - mu cos). The test measures between the
// steps 5, 25 and 45, so that the start does not count. The fitted wall is not quite straight: a
// hundredth of a millimetre.
constexpr double kGravity = 100, kDt = 0.01;

double acceleration(double friction, double angle) {
  const std::string gravity = std::to_string(kGravity * std::sin(angle)) + " " +
                              std::to_string(-kGravity * std::cos(angle)) + " 0";
  ContactScene s(freeBeam(friction), gravity);
  double at[3];
  for (int part = 0; part < 3; ++part) {
    s.run(part == 0 ? 5 : 20);
    at[part] = s.state->getPX(2);
    EXPECT_LT(s.contact->d_penetration.getValue(), 0.01);
  }
  EXPECT_GT(s.contact->d_contacts.getValue(), 0U);
  return (at[2] - 2 * at[1] + at[0]) / (20 * kDt * 20 * kDt);
}

TEST_F(BeamBlobContact, SticksOnAnInclineBelowTheAngleOfFriction) {
  EXPECT_NEAR(acceleration(0.3, std::atan(0.25)), 0, 0.02 * kGravity);
}

TEST_F(BeamBlobContact, SlidesOnAnInclineAsCoulombStates) {
  const double angle = std::atan(0.4);
  for (const double friction : {0.0, 0.1, 0.3}) {
    const double expected = kGravity * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(acceleration(friction, angle), expected, 0.02 * kGravity)
        << "friction " << friction;
  }
}

}  // namespace
}  // namespace lumensofa::test
