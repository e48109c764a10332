// SPDX-License-Identifier: Apache-2.0
// Measures of shapes with closed forms, whose nodes and models are exact.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/judge/measure/wall.h"
#include "tests/unit/measure/shapes.h"

namespace lumen::convert::test {
namespace {

using Eigen::Vector3d;

// A tenth of what docs/measures.md promises of measures through volumes.
constexpr double kLength = 0.0005, kCurvature = 0.003, kTorsion = 0.008, kArea = 0.002,
                 kAngle = 0.2, kVolume = 0.002, kIndex = 0.003;

void expectShare(const Measured& found, double truth, double share) {
  EXPECT_EQ(found.absent, "");
  EXPECT_NEAR(found.value, truth, share * std::abs(truth));
}

TEST(ClosedForm, OfAHelixAreItsLengthCurvatureAndTorsion) {
  constexpr double kRadius = 8, kRise = 2, kTurns = 2;
  const CaseMeasures m = measuresOf(treeOf({helixTube(kRadius, kRise, kTurns, 1)}, 0.4));
  const double square = kRadius * kRadius + kRise * kRise, curvature = kRadius / square;
  ASSERT_EQ(m.vessels.size(), 1U);
  const VesselMeasures& v = m.vessels[0];
  const double length = 2 * kPi * kTurns * std::sqrt(square), chord = 2 * kPi * kTurns * kRise;
  expectShare(v.length, length, kLength);
  expectShare(v.chord, chord, kLength);
  expectShare(v.tortuosity, length / chord - 1, kLength);
  expectShare(v.meanCurvature, curvature, kCurvature);
  expectShare(v.greatestCurvature, curvature, kCurvature);
  expectShare(v.turning, curvature * 1800 / kPi, kCurvature);
  expectShare(v.sumOfAngles, 10 / std::sqrt(square), kCurvature);
  expectShare(v.inflectionCount, length / chord, kLength);
  EXPECT_EQ(v.turns.value, 1);
  std::size_t whole = 0;
  for (const StationMeasures& station : m.stations) {
    if (!station.torsion.absent.empty()) continue;
    ++whole;
    expectShare(station.curvature, curvature, kCurvature);
    expectShare(station.torsion, kRise / square, kTorsion);
  }
  EXPECT_GT(whole, m.stations.size() * 3 / 4);
}

TEST(ClosedForm, OfALeftHandedHelixIsANegativeTorsion) {
  const CaseMeasures m = measuresOf(treeOf({helixTube(8, -2, 2, 1)}, 0.4));
  expectShare(m.stations[m.stations.size() / 2].torsion, -2.0 / 68, kTorsion);
}

TEST(ClosedForm, OfATorusArcAreItsVolumeAndWall) {
  constexpr double kBend = 8, kRadius = 1.5, kAngleOfArc = kPi;
  const CaseMeasures m = measuresOf(caseOf({arcTube(kBend, kAngleOfArc, kRadius)}, 0.25));
  const VesselMeasures& v = m.vessels[0];
  expectShare(v.length, kBend * kAngleOfArc, kLength);
  expectShare(v.volume, kPi * kRadius * kRadius * kBend * kAngleOfArc, kVolume);
  expectShare(v.wallArea, 2 * kPi * kRadius * kBend * kAngleOfArc, kVolume);
  expectShare(v.meanCurvature, 1 / kBend, kCurvature);
  EXPECT_EQ(v.turns.value, 1);
  const StationMeasures& middle = m.stations[m.stations.size() / 2];
  expectShare(middle.area, kPi * kRadius * kRadius, kArea);
  expectShare(middle.perimeter, 2 * kPi * kRadius, kArea);
  expectShare(middle.radius, kRadius, kArea);
}

TEST(ClosedForm, OfAConeAreItsTaperAndRadii) {
  constexpr double kFrom = 2.5, kSlope = 0.04, kLengthOfCone = 30;
  Tube cone = straightTube(Vector3d::Zero(), Vector3d(1, 2, 2), kLengthOfCone, 1);
  cone.radius = [](double s) { return kFrom - kSlope * s; };
  const CaseMeasures m = measuresOf(caseOf({cone}, 0.1));
  expectShare(m.vessels[0].taper, 2 * kSlope, kIndex);
  const double to = kFrom - kSlope * kLengthOfCone;
  expectShare(m.vessels[0].volume, kPi * kLengthOfCone / 3 * (kFrom * kFrom + kFrom * to + to * to),
              kVolume);
  const StationMeasures& middle = m.stations[m.stations.size() / 2];
  const double radius = kFrom - kSlope * middle.along.value;
  // the nearest point of a cone is not in the plane of its axis' normal
  expectShare(middle.radius, radius / std::hypot(1, kSlope), kArea);
  expectShare(middle.area, kPi * radius * radius, kArea);
  expectShare(middle.taper, 2 * kSlope, kIndex);
}

TEST(ClosedForm, OfAnEllipseAreTheFiguresOfItsSection) {
  constexpr double kWide = 2, kNarrow = 1.2;
  // the axis is off the ellipse's centre
  const CutPlane plane{Vector3d(5, 6, 7), Vector3d::UnitZ(), 0, 1.5};
  const Vector3d centre = plane.centre + Vector3d(0.2, 0.1, 0);
  const auto [u, v] = planeBasis(plane.tangent);
  WallRing ring;
  for (std::size_t i = 0; i < WallRing::kRays; ++i) {
    const double angle = 2 * kPi * static_cast<double>(i) / WallRing::kRays;
    const Vector3d ray = std::cos(angle) * u + std::sin(angle) * v;
    double rho = 0;
    for (double step = 4; step > 1e-14; step /= 2) {
      const Vector3d p = plane.centre + (rho + step) * ray - centre;
      if (std::hypot(p.x() / kWide, p.y() / kNarrow) < 1) rho += step;
    }
    const Vector3d out = plane.centre + rho * ray - centre;
    ring.point[i] = plane.centre + rho * ray;
    ring.distance[i] = rho;
    ring.normal[i] =
        Vector3d(out.x() / (kWide * kWide), out.y() / (kNarrow * kNarrow), 0).normalized();
  }
  const Section section = sectionOf(plane, ring, Vector3d(0.1, 0, 0));
  const double h = std::pow((kWide - kNarrow) / (kWide + kNarrow), 2);
  // Ramanujan's second formula, right to 1e-7 here
  const double perimeter = kPi * (kWide + kNarrow) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
  EXPECT_NEAR(section.area, kPi * kWide * kNarrow, 1e-6);
  EXPECT_NEAR(section.perimeter, perimeter, 1e-5);
  EXPECT_NEAR(section.greatest, 2 * kWide, 0.002 * kWide);
  EXPECT_NEAR(section.least, 2 * kNarrow, 0.002 * kNarrow);
  EXPECT_NEAR(section.circularity, 4 * kPi * section.area / (perimeter * perimeter), 1e-5);
  EXPECT_NEAR((section.centroid - centre).norm(), 0, 1e-6);
  // Pappus: the centroid lies 0.2 mm towards the centre of a curvature of 0.1 / mm
  EXPECT_NEAR(section.volumeRate, section.area * 0.98, 1e-6);
}

TEST(ClosedForm, OfAStenosisAreItsDegreesLengthAndPlace) {
  constexpr double kRadius = 1.5, kDepth = 0.5, kHalf = 5, kMiddle = 22;
  Tube tube = straightTube(Vector3d::Zero(), Vector3d(0, 1, 1), 44, 1);
  tube.radius = [](double s) {
    const double x = (s - kMiddle) / kHalf;
    return kRadius * (std::abs(x) < 1 ? 1 - 0.5 * kDepth * (1 + std::cos(kPi * x)) : 1.0);
  };
  const CaseMeasures m = measuresOf(caseOf({tube}, 0.1));
  ASSERT_EQ(m.narrowings.size(), 1U);
  const NarrowingMeasures& n = m.narrowings[0];
  EXPECT_FALSE(n.isDilation);
  expectShare(n.diameterDegree, 100 * kDepth, kIndex);
  expectShare(n.areaDegree, 100 * (1 - kDepth * kDepth), kIndex);
  expectShare(n.healthyDiameter, 2 * kRadius, kIndex);
  EXPECT_NEAR(n.along.value, kMiddle, n.along.plusMinus);
  // where 1 - (1 + cos)/4 is 0.9
  const double half = kHalf * std::acos(0.4 - 1) / kPi;
  expectShare(n.length, 2 * half, 0.02);
}

TEST(ClosedForm, OfAForkAreItsAngles) {
  constexpr double kRadius = 1.5, kDaughter = 1.2;
  const double large = 25 * kPi / 180, small = 50 * kPi / 180;
  Tube trunk = straightTube(Vector3d(0, 0, -20), Vector3d::UnitZ(), 20, kRadius);
  Tube a =
      straightTube(Vector3d::Zero(), Vector3d(std::sin(large), 0, std::cos(large)), 20, kDaughter);
  Tube b = straightTube(Vector3d::Zero(), Vector3d(-std::sin(small), 0, std::cos(small)), 20, 1);
  a.label = "a", b.label = "b";
  a.parent = b.parent = 0;
  a.parentAlong = b.parentAlong = 20;
  for (const formats::Case& value : {treeOf({trunk, a, b}, 0.5), caseOf({trunk, a, b}, 0.25)}) {
    const CaseMeasures m = measuresOf(value);
    ASSERT_EQ(m.forks.size(), 1U);
    const ForkMeasures& fork = m.forks[0];
    EXPECT_EQ(fork.larger, 1U);
    EXPECT_NEAR(fork.angle.value, 75, kAngle);
    EXPECT_NEAR(fork.takeOffLarger.value, 25, kAngle);
    EXPECT_NEAR(fork.takeOffSmaller.value, 50, kAngle);
    EXPECT_NEAR(fork.inPlaneLarger.value, 25, kAngle);
    EXPECT_NEAR(fork.inPlaneSmaller.value, 50, kAngle);
    EXPECT_NEAR(fork.outOfPlaneParent.value, 0, kAngle);
    expectShare(fork.areaRatio, (1.44 + 1) / 2.25, kArea * 2);
    expectShare(fork.asymmetry, 1 / 1.44, kArea * 2);
    ASSERT_EQ(m.paths.size(), 2U);
    EXPECT_EQ(m.paths[1].forks.value, 1);
    EXPECT_NEAR(m.paths[1].takeOff.value, 50, kAngle);
    expectShare(m.paths[1].calibreStep, 1 / kRadius, kArea);
    expectShare(m.paths[1].catheter, 6, kIndex);
  }
}

TEST(ClosedForm, OfAForkByMurraysLawIsTheExponentThree) {
  const double smaller = std::cbrt(1.5 * 1.5 * 1.5 - 1.2 * 1.2 * 1.2);
  Tube trunk = straightTube(Vector3d(0, 0, -20), Vector3d::UnitZ(), 20, 1.5);
  Tube a = straightTube(Vector3d::Zero(), Vector3d(0.4, 0, 1), 20, 1.2);
  Tube b = straightTube(Vector3d::Zero(), Vector3d(-1, 0, 1), 20, smaller);
  a.label = "a", b.label = "b";
  a.parent = b.parent = 0;
  a.parentAlong = b.parentAlong = 20;
  EXPECT_NEAR(measuresOf(treeOf({trunk, a, b}, 0.5)).forks[0].murrayExponent.value, 3, 1e-4);
}

}  // namespace
}  // namespace lumen::convert::test
