// SPDX-License-Identifier: Apache-2.0
// Intervals hold the truth, and measures do not depend on how a vessel is sampled.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/judge/measure/smooth_axis.h"
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
