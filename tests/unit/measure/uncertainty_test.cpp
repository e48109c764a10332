// SPDX-License-Identifier: Apache-2.0
// Intervals hold the truth, and measures do not depend on how a vessel is sampled.
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/neck_plane.h"
#include "converters/judge/measure/sac_shape.h"
#include "converters/judge/measure/sac_tree.h"
#include "converters/judge/measure/smooth_axis.h"
#include "converters/judge/measure/wall.h"
#include "tests/unit/measure/shapes.h"

namespace lumen::convert::test {
namespace {

/// Moves every centre by independent errors of this standard deviation in each direction.
void shake(formats::Case& value, double sd, std::uint64_t seed) {
  Random random(seed);
  const auto error = [&] {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += random.uniform();
    return static_cast<float>(sd * (sum - 6));
  };
  for (formats::Vec3f& centre : value.tree.centre) {
    centre.x += error();
    centre.y += error();
    centre.z += error();
  }
}

bool holds(const Measured& found, double truth) {
  return std::abs(found.value - truth) <= found.plusMinus;
}

TEST(Uncertainty, OfTheCurveHoldsTheTruthInNineteenOfTwentyDraws) {
  constexpr double kRadius = 8, kRise = 2, kSquare = kRadius * kRadius + kRise * kRise;
  constexpr int kDraws = 200;
  int curvature = 0, torsion = 0, mean = 0, position = 0;
  for (int seed = 1; seed <= kDraws; ++seed) {
    formats::Case value = treeOf({helixTube(kRadius, kRise, 1, 1)}, 0.4);
    shake(value, 0.03, static_cast<std::uint64_t>(seed));
    const CaseMeasures m = measuresOf(value);
    const StationMeasures& middle = m.stations[m.stations.size() / 2];
    curvature += holds(middle.curvature, kRadius / kSquare);
    torsion += holds(middle.torsion, kRise / kSquare);
    mean += holds(m.vessels[0].meanCurvature, kRadius / kSquare);
    position += std::abs(std::hypot(middle.place.x(), middle.place.y()) - kRadius) < 0.02;
  }
  // five in a hundred, and three standard deviations of that count
  constexpr int kMinHits = kDraws - 10 - 9;
  EXPECT_GE(curvature, kMinHits);
  EXPECT_GE(torsion, kMinHits);
  EXPECT_GE(mean, kMinHits);
  // intervals are not so wide that nothing could fail them
  EXPECT_LT(curvature + torsion, 2 * kDraws);
  EXPECT_GE(position, kMinHits);
}

TEST(Uncertainty, OfAForksAnglesHoldsTheTruthInNineteenOfTwentyDraws) {
  constexpr int kDraws = 200;
  int held = 0;
  for (int seed = 1; seed <= kDraws; ++seed) {
    Tube trunk = straightTube({0, 0, -20}, Eigen::Vector3d::UnitZ(), 20, 1.5);
    Tube a = straightTube({0, 0, 0}, {std::sin(0.5), 0, std::cos(0.5)}, 20, 1.2);
    Tube b = straightTube({0, 0, 0}, {-std::sin(0.7), 0, std::cos(0.7)}, 20, 1);
    a.label = "a", b.label = "b", a.parent = b.parent = 0, a.parentAlong = b.parentAlong = 20;
    formats::Case value = treeOf({trunk, a, b}, 0.4);
    shake(value, 0.03, static_cast<std::uint64_t>(seed));
    held += holds(measuresOf(value).forks[0].angle, 1.2 * 180 / kPi);
  }
  EXPECT_GE(held, kDraws - 10 - 9);
  EXPECT_LT(held, kDraws);
}

TEST(Uncertainty, OfTheWallFollowsTheSpreadOfItsPointsAndTheVoxel) {
  formats::Case value = caseOf({straightTube({0, 0, 0}, {0, 0, 1}, 20, 1.5)}, 0.5);
  const auto areaOf = [&] {
    const CaseMeasures m = measuresOf(value);
    return m.stations[m.stations.size() / 2].area;
  };
  EXPECT_TRUE(std::isnan(areaOf().plusMinus));  // no point, no interval
  addPoints(value, 0.2, [](std::size_t i) { return i % 2 == 0 ? 0.05 : -0.05; });
  const double fine = areaOf().plusMinus;
  addPoints(value, 0.2, [](std::size_t i) { return i % 2 == 0 ? 0.2 : -0.2; });
  EXPECT_GT(areaOf().plusMinus, 1.5 * fine);
  addPoints(value, 0.8, [](std::size_t i) { return i % 2 == 0 ? 0.05 : -0.05; });
  EXPECT_GT(areaOf().plusMinus, 1.5 * fine);
}

/// A bent vessel that narrows, as a function of the distance of its nodes.
formats::Case vesselAt(double spacing) {
  Tube tube = helixTube(7, 1.5, 0.6, 1);
  tube.radius = [](double s) { return 1.5 - 0.015 * s; };
  formats::Case value = caseOf({tube}, spacing);
  addPoints(value, 0.2, [](std::size_t i) { return i % 2 == 0 ? 0.04 : -0.04; });
  return value;
}

TEST(Sampling, StationsAtHalfOrTwiceTheStepChangeNoOtherMeasure) {
  const formats::Case value = vesselAt(0.3);
  const CaseMeasures usual = measuresOf(value, {0.5});
  for (const double step : {0.25, 1.0}) {
    const CaseMeasures other = measuresOf(value, {step});
    EXPECT_EQ(other.vessels[0].volume.value, usual.vessels[0].volume.value);
    EXPECT_EQ(other.vessels[0].meanCurvature.value, usual.vessels[0].meanCurvature.value);
    // the stations that both have are the same
    const std::size_t every = step < 0.5 ? 2 : 1, in = step < 0.5 ? 1 : 2;
    for (std::size_t i = 0; i * in < usual.stations.size(); ++i) {
      const StationMeasures &a = usual.stations[i * in], &b = other.stations[i * every];
      EXPECT_DOUBLE_EQ(a.along.value, b.along.value);
      EXPECT_DOUBLE_EQ(a.area.value, b.area.value);
      if (a.taper.absent.empty()) {
        EXPECT_NEAR(a.taper.value, b.taper.value, a.taper.plusMinus + b.taper.plusMinus);
      }
    }
  }
}

TEST(Sampling, NodesAtHalfOrTwiceTheDistanceChangeMeasuresByLessThanTheirIntervals) {
  const CaseMeasures usual = measuresOf(vesselAt(0.4));
  for (const double spacing : {0.2, 0.8}) {
    const CaseMeasures other = measuresOf(vesselAt(spacing));
    const VesselMeasures &a = usual.vessels[0], &b = other.vessels[0];
    for (const auto member :
         {&VesselMeasures::length, &VesselMeasures::chord, &VesselMeasures::meanCurvature,
          &VesselMeasures::smallestRadius, &VesselMeasures::meanRadius, &VesselMeasures::volume,
          &VesselMeasures::wallArea, &VesselMeasures::turning})
      EXPECT_NEAR((a.*member).value, (b.*member).value,
                  std::max((a.*member).plusMinus, (b.*member).plusMinus))
          << spacing;
    EXPECT_EQ(a.turns.value, b.turns.value);
  }
}

TEST(Sampling, TheScaleOfTheCurveFollowsTheRadiusNotTheNodes) {
  for (const double spacing : {0.2, 0.4}) {
    const Tube tube = helixTube(8, 2, 1, 1.2);
    AxisNodes nodes;
    for (double s = 0; s <= tube.length; s += spacing) {
      nodes.position.push_back(tube.position(s));
      nodes.radius.push_back(1.2);
    }
    const SmoothAxis axis(nodes);
    EXPECT_NEAR(axis.at(0.5 * axis.length()).half, 6 * 1.2, 1e-9);
  }
}

}  // namespace
}  // namespace lumen::convert::test

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

const Frame kFrame{0.2, 25.4};

double truth(const Design& design, const std::string& measure) {
  return std::get<double>(design.notes.at("true.sac." + measure));
}

std::vector<SacMeasures> measureSacsOf(const formats::Case& source) {
  const WallNoise noise(source, Wall(source));
  return measureSacs(source, &noise, Progress());
}

// The wall of a design, exactly.
SacShape shapeOfDesign(const Design& design) {
  const TubeTreeDistance wall(design.tree);
  const SacTree sac = findSacs(design.tree).front();
  BoxedField field;
  for (const std::uint32_t n : sac.nodes)
    field.box.add(toEigen(design.tree.centre[n]), static_cast<double>(design.tree.radius[n]) + 2);
  field.value = [&](const Vector3d& p) { return -wall.nearest(p).distance; };
  const auto attachment = static_cast<std::size_t>(sac.attachment);
  const NeckPlace place{toEigen(design.tree.centre[attachment]), sac.middle, {}};
  const Progress progress;
  const auto shape =
      findSacShape(field, place, toEigen(design.tree.centre[sac.widest]), sac.radius, 0, progress);
  return shape.value();
}

// A tenth of what docs/measures.md promises of indices and volumes of a fitted case.
void expectTruth(const Design& design) {
  const DomeShape shape = shapeOfDesign(design).shape;
  EXPECT_NEAR(shape.volume / truth(design, "dome_volume_mm3"), 1, 0.002);
  EXPECT_NEAR(shape.area / truth(design, "dome_area_mm2"), 1, 0.002);
  EXPECT_NEAR(shape.width / truth(design, "width_mm"), 1, 0.003);
  EXPECT_NEAR(shape.height / truth(design, "height_mm"), 1, 0.003);
  EXPECT_NEAR(shape.reach / truth(design, "height_mm"), 1, 0.003);
  // the plane that touches a vessel does so up to a fiftieth of a triangle's edge
  EXPECT_NEAR(shape.neckDiameter / truth(design, "neck_diameter_mm"), 1, 0.004);
  EXPECT_NEAR(shape.neckArea / truth(design, "neck_area_mm2"), 1, 0.008);
  EXPECT_NEAR(1 - shape.volume / shape.hullVolume, 0, 0.003);
}

TEST(SacShape, OfABallOnATubeIsItsClosedForm) {
  expectTruth(designSacSphere(kFrame));
}

TEST(SacShape, OfAnEllipsoidOnATubeIsItsClosedForm) {
  expectTruth(designSacEllipsoid(kFrame));
}

TEST(SacShape, OfABallInAForkIsItsClosedForm) {
  expectTruth(designSacFork(kFrame));
}

// Wall points without noise: errors left are those of the fit.
TEST(SacMeasures, OfAFittedBallAreNearItsClosedForm) {
  const Design design = designSacSphere(kFrame);
  const auto sacs = measureSacsOf(test::caseOfDesign(design, 0.5, 0.2));
  ASSERT_EQ(sacs.size(), 1U);
  const SacMeasures& sac = sacs[0];
  EXPECT_EQ(sac.position, "side-wall");
  EXPECT_NEAR(sac.volume.value / truth(design, "dome_volume_mm3"), 1, 0.02);
  EXPECT_NEAR(sac.width.value / truth(design, "width_mm"), 1, 0.02);
  EXPECT_NEAR(sac.inflowAngle.value, 90, 2);
  EXPECT_GT(sac.volume.plusMinus, 0);
}

TEST(SacMeasures, AreEmptyWithAReasonWithoutModels) {
  formats::Case source;
  source.tree = designSacSphere(kFrame).tree;
  const auto sacs = measureSacs(source, nullptr, Progress());
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_TRUE(std::isnan(sacs[0].volume.value));
  EXPECT_EQ(sacs[0].volume.absent, "the case has no models: fit it first");
}

TEST(SacMeasures, AreEmptyWithAReasonForASacWithoutAVessel) {
  const Design design = designSacSphere(kFrame);
  formats::Case source = test::caseOfDesign(design, 0.5, 0.1);
  source.tree.branches[1].parentNode = formats::kNoParent;
  source.tree.parent[source.tree.branches[1].firstNode] = formats::kNoParent;
  const auto sacs = measureSacsOf(source);
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_EQ(sacs[0].neckDiameter.absent, "the aneurysm hangs on no vessel");
}

TEST(SacTree, LobesBelongToTheSacThatTheyHangOn) {
  const Design design = designSacLobes(kFrame);
  const std::vector<SacTree> sacs = findSacs(design.tree);
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_EQ(sacs[0].branches.size(), 3U);
  EXPECT_EQ(design.tree.branch[static_cast<std::size_t>(sacs[0].attachment)], 0U);
}

TEST(SacTree, TheVesselTowardsTheRootComesFirst) {
  const Design design = designSacFork(kFrame);
  const SacTree sac = findSacs(design.tree).front();
  const std::vector<SacVessel> vessels = vesselsAtNeck(design.tree, sac, 2);
  ASSERT_EQ(vessels.size(), 3U);
  EXPECT_LT(vessels[0].node, static_cast<std::uint32_t>(sac.attachment));
  for (const SacVessel& v : vessels) EXPECT_NEAR(v.diameter, 2.6, 1e-4);
}

// The part of a ball beyond a plane: area of the section and volume of the cap.
TEST(PlaneCutter, CutsACapOffABall) {
  BoxedField field;
  field.box.add(Vector3d::Zero(), 3.5);
  field.value = [](const Vector3d& p) { return 3 - p.norm(); };
  const Progress progress;
  const SampledField samples(field, 0.1, nullptr, progress);
  const LocalSurface surface = samples.surface(Vector3d::Zero());
  const Vector3d along = Vector3d(1, 2, 3).normalized();
  PlaneCutter cutter(surface, {-2.9 * along, Vector3d::Zero(), {}});
  const auto cut = cutter.cut({along, 1});
  ASSERT_TRUE(cut);
  constexpr double kPi = 3.141592653589793;
  EXPECT_NEAR(cut->area / (kPi * 8), 1, 0.002);
  EXPECT_NEAR(cut->volume / (kPi * 4 * 7 / 3), 1, 0.002);
  // a plane below the vessel's axis separates nothing
  EXPECT_FALSE(cutter.cut({along, -2.95}));
}

// Samples near the wall alone give the surface that all samples give.
TEST(SampledField, SkipsOnlySamplesAwayFromTheWall) {
  BoxedField field;
  field.box.add(Vector3d(0.3, -0.2, 0.1), 3.5);
  field.value = [](const Vector3d& p) { return 3 - (p - Vector3d(0.3, -0.2, 0.1)).norm(); };
  const Progress progress;
  const SampledField coarse(field, 0.4, nullptr, progress);
  std::atomic<int> calls = 0;
  const BoxedField counted{field.box, [&](const Vector3d& p) {
                             ++calls;
                             return field.value(p);
                           }};
  const SampledField fewer(counted, 0.2, &coarse, progress);
  const int some = calls.exchange(0);
  const SampledField all(counted, 0.2, nullptr, progress);
  EXPECT_LT(some, 0.6 * calls);
  const LocalSurface a = fewer.surface(Vector3d::Zero()), b = all.surface(Vector3d::Zero());
  EXPECT_EQ(a.mesh.triangle, b.mesh.triangle);
  EXPECT_EQ(a.mesh.position, b.mesh.position);
}

TEST(SmoothAxis, IsALineBetweenNodesThatLieFartherApartThanItsWindowReaches) {
  AxisNodes nodes;
  for (const double x : {0.0, 7.0, 20.0, 27.5, 60.0}) {
    nodes.position.push_back({x, 0, 0});
    nodes.radius.push_back(1);
  }
  const SmoothAxis axis(nodes);
  EXPECT_NEAR(axis.length(), 60, 1e-6);
  for (double along = 0; along <= 60; along += 0.25)
    EXPECT_NEAR((axis.at(along).position - Eigen::Vector3d(along, 0, 0)).norm(), 0, 1e-5) << along;
}

}  // namespace
}  // namespace lumen::convert
