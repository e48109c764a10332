// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "shapes.h"

namespace lumen::convert::fitting {
namespace {

using formats::Kernel;
using formats::Vec3d;

EnergyParameters parametersFor(Kernel kernel) {
  EnergyParameters p;
  p.kernel = kernel;
  p.kernelParameter = formats::defaultKernelParameter(kernel);
  return p;
}

/// With 301 points, every fourth is a sample, and the points fill no whole number of lanes.
constexpr int kMany = 301;

/// 101 points: not a whole number of lanes.
std::vector<Vec3d> scatteredPoints(int count = 101) {
  Random random(3);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  }
  return points;
}

/// Wide enough for the compact kernels to reach every point.
std::vector<Blob> scatteredBlobs(double width) {
  Random random(4);
  std::vector<Blob> blobs;
  for (int i = 0; i < 5; ++i) {
    blobs.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                     width * random.uniform(1, 1.3)});
  }
  return blobs;
}

double& coordinate(Blob& b, std::size_t i) {
  switch (i) {
    case 0:
      return b.x;
    case 1:
      return b.y;
    case 2:
      return b.z;
    default:
      return b.width;
  }
}

/// Largest difference between analytic and central differences, relative to the largest derivative.
double derivativeError(const EnergyParameters& parameters, std::vector<Blob> blobs,
                       std::size_t active, const std::vector<Vec3d>& seam = {}, int points = 101,
                       Energy::At where = Energy::At::AllPoints) {
  Energy energy(parameters);
  energy.setPoints(scatteredPoints(points), seam, 2);
  energy.freeze(blobs, active, where);
  const std::size_t n = 4 * (blobs.size() - active);
  std::vector<double> a(n * n), b(n);
  energy.linearise(blobs);
  energy.normalEquations(blobs, a, b);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    constexpr double kStep = 1e-5;
    double& value = coordinate(blobs[active + i / 4], i % 4);
    const double at = value;
    value = at + kStep;
    const double above = energy.evaluate(blobs);
    value = at - kStep;
    const double below = energy.evaluate(blobs);
    value = at;
    const double expected = (above - below) / (2 * kStep);
    worst = std::max(worst, std::abs(2 * b[i] - expected));
    largest = std::max(largest, std::abs(expected));
  }
  return worst / largest;
}

TEST(Energy, SeamsCountInTheDataTermOnly) {
  EnergyParameters p = parametersFor(Kernel::Cauchy);
  p.cohesionWeight = 0;
  const std::vector<Vec3d> points = scatteredPoints(), seam{{0.5, 0.2, 0.1}, {-0.4, 0.3, 0.9}};
  const std::vector<Blob> blobs = scatteredBlobs(0.6);
  Energy plain(p), shared(p), ofSeam(p);
  plain.setPoints(points);
  shared.setPoints(points, seam, 3);
  ofSeam.setPoints(seam);
  for (Energy* energy : {&plain, &shared, &ofSeam}) energy->evaluate(blobs);
  EXPECT_NEAR(shared.terms().data, plain.terms().data + 3 * ofSeam.terms().data, 1e-14);
  EXPECT_NEAR(shared.terms().curvature, plain.terms().curvature, 1e-12);
  EXPECT_NEAR(shared.slope(), plain.slope(), 1e-14);
  EXPECT_EQ(shared.field().size(), points.size());
}

class EnergyOfKernel : public testing::TestWithParam<Kernel> {
protected:
  [[nodiscard]] static double width() { return GetParam() >= Kernel::Quartic ? 3.0 : 0.6; }
};

TEST_P(EnergyOfKernel, DataDerivativesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.cohesionWeight = p.curvatureWeight = 0;
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0), 1e-6);
}

TEST_P(EnergyOfKernel, NormalisedDataDerivativesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.cohesionWeight = p.curvatureWeight = 0;
  p.referenceSlope = 0.3;
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0), 1e-6);
}

TEST_P(EnergyOfKernel, DerivativesWithSeamsMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.referenceSlope = 0.3;
  const std::vector<Vec3d> seam{{0.5, 0.2, 0.1}, {-0.4, 0.3, 0.9}, {0.1, -0.7, 0.3}};
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0, seam), 1e-6);
}

TEST_P(EnergyOfKernel, CurvatureDerivativesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.isoLevel = 0;
  p.cohesionWeight = 0;
  p.curvatureWeight = 1e8;  // leaves the data term below the tolerance
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0), 1e-5);
}

TEST_P(EnergyOfKernel, EvennessDerivativesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.cohesionWeight = p.curvatureWeight = 0;
  p.evennessWeight = 1e6;
  p.evenWidth = 0.5;
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0), 1e-6);
}

TEST_P(EnergyOfKernel, CohesionDerivativesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.curvatureWeight = 0;
  p.cohesionWeight = 1e8;
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 0), 1e-6);
}

TEST_P(EnergyOfKernel, DerivativesOfTheUnknownBlobsDoNotChangeWhenTheOthersAreFrozen) {
  EnergyParameters p = parametersFor(GetParam());
  p.referenceSlope = 0.3;
  p.cohesionWeight = p.curvatureWeight = 0.1;
  EXPECT_LT(derivativeError(p, scatteredBlobs(width()), 3), 1e-5);
}

TEST_P(EnergyOfKernel, DerivativesOfManyPointsWithSeamsMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  p.referenceSlope = 0.3;
  const std::vector<Vec3d> seam{{0.5, 0.2, 0.1}, {-0.4, 0.3, 0.9}, {0.1, -0.7, 0.3}};
  for (const std::size_t active : {0U, 3U})
    EXPECT_LT(derivativeError(p, scatteredBlobs(width()), active, seam, kMany), 1e-6) << active;
}

TEST_P(EnergyOfKernel, DerivativesAtTheSamplesMatchCentralDifferences) {
  EnergyParameters p = parametersFor(GetParam());
  for (const double slope : {0.0, 0.3}) {
    p.referenceSlope = slope;
    for (const std::size_t active : {0U, 3U})
      EXPECT_LT(derivativeError(p, scatteredBlobs(width()), active, {}, kMany, Energy::At::Samples),
                1e-6)
          << active << ", slope " << slope;
  }
}

TEST_P(EnergyOfKernel, FreezingBlobsDoesNotChangeTheEnergy) {
  const std::vector<Blob> blobs = scatteredBlobs(width());
  Energy energy(parametersFor(GetParam()));
  energy.setPoints(scatteredPoints());
  energy.freeze(blobs, 0);
  const double all = energy.evaluate(blobs);
  energy.freeze(blobs, 3);
  EXPECT_NEAR(energy.evaluate(blobs), all, 1e-12 * all);
}

TEST_P(EnergyOfKernel, FieldAgreesWithTheScalarReference) {
  const std::vector<Blob> blobs = scatteredBlobs(width());
  const std::vector<Vec3d> points = scatteredPoints(kMany);
  formats::BlobbyModels models;
  models.kernel = GetParam();
  models.kernelParameter = formats::defaultKernelParameter(GetParam());
  models.offset = {0, static_cast<std::uint32_t>(blobs.size())};
  std::vector<Blob> rounded;  // the model holds floats
  for (const Blob& b : blobs) {
    models.centre.push_back(
        {static_cast<float>(b.x), static_cast<float>(b.y), static_cast<float>(b.z)});
    models.width.push_back(static_cast<float>(b.width));
    const formats::Vec3f& c = models.centre.back();
    rounded.push_back({c.x, c.y, c.z, models.width.back()});
  }
  Energy energy(parametersFor(GetParam()));
  energy.setPoints(points);
  energy.evaluate(rounded);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const formats::FieldValue expected = formats::evaluateField(models, 0, energy.point(k));
    const Vec3d& g = expected.gradient;
    EXPECT_NEAR(energy.field()[k], expected.f, 1e-13);
    EXPECT_NEAR(energy.gradientSquared()[k], g.x * g.x + g.y * g.y + g.z * g.z, 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EnergyOfKernel,
                         testing::Values(Kernel::Cauchy, Kernel::Gaussian, Kernel::Quartic,
                                         Kernel::SoftObject),
                         [](const auto& tested) { return test::kernelName(tested.param); });

TEST(Energy, CurvatureAndSlopeOfManyPointsAreThoseOfEveryFourth) {
  const EnergyParameters p = parametersFor(Kernel::Quartic);
  const std::vector<Vec3d> points = scatteredPoints(kMany);
  std::vector<Vec3d> fourth;
  for (std::size_t k = 0; k < 72; ++k) fourth.push_back(points[4 * k]);
  const std::vector<Blob> blobs = scatteredBlobs(3);
  Energy all(p), few(p);
  all.setPoints(points);
  few.setPoints(fourth);
  for (Energy* energy : {&all, &few}) energy->evaluate(blobs);
  EXPECT_NEAR(all.slope(), few.slope(), 1e-14);
  EXPECT_NEAR(all.terms().curvature, few.terms().curvature, 1e-12);
  EXPECT_NEAR(all.meanCurvature(), few.meanCurvature(), 1e-12);
  double data = 0;
  for (const double f : all.field()) data += (p.isoLevel - f) * (p.isoLevel - f) / kMany;
  EXPECT_NEAR(all.terms().data, data, 1e-12 * data);
}

TEST(Energy, SamplesStandForAllPoints) {
  std::vector<Vec3d> points;
  for (const Vec3d& p : scatteredPoints(80)) points.insert(points.end(), 4, p);
  const std::vector<Blob> blobs = scatteredBlobs(0.6);
  EnergyParameters p;
  p.referenceSlope = 0.3;
  Energy energy(p);
  energy.setPoints(points);
  const double all = energy.evaluate(blobs);
  energy.freeze(blobs, 2, Energy::At::Samples);
  EXPECT_NEAR(energy.evaluate(blobs), all, 1e-12 * all);
}

TEST(Energy, EveryPointIsThereOnceInWhateverOrder) {
  const std::vector<Vec3d> seam{{2, 0, 0}, {3, 0, 0}};
  Energy energy({});
  for (int count = 1; count < 700; count += 23) {
    const std::vector<Vec3d> points = scatteredPoints(count);
    energy.setPoints(points, seam, 2);
    std::vector<std::array<double, 3>> given, found;
    for (const Vec3d& p : points) given.push_back({p.x, p.y, p.z});
    for (std::size_t k = 0; k < energy.pointCount(); ++k) {
      const Vec3d p = energy.point(k);
      found.push_back({p.x, p.y, p.z});
    }
    std::sort(given.begin(), given.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, given) << count;
  }
}

TEST(Energy, DataTermIsTheMeanSquareOfTMinusF) {
  // f = 0.5 at the centre of a blob of width 0.5, and 0.5 (1 - 0.25)^2 = 0.28125 at half a width
  Energy energy(parametersFor(Kernel::Quartic));
  energy.setPoints(std::vector<Vec3d>{{0, 0, 0}, {0.25, 0, 0}});
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 0.5}});
  EXPECT_NEAR(energy.terms().data, (0.4 * 0.4 + 0.18125 * 0.18125) / 2, 1e-12);
}

TEST(Energy, DataTermOfCauchyBlobsComesFromTheFourthRootOfTheField) {
  // f = 1.6 in the centre, and 1.6 (1 + 0.2 * 15)^-2 = 0.1 = T at sqrt(15) widths: u = 4 T (1/2 -
  // 1)
  Energy energy({});
  energy.setPoints(std::vector<Vec3d>{{0, 0, 0}, {1.6 * std::sqrt(15.0), 0, 0}});
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 1.6}});
  EXPECT_NEAR(energy.terms().data, 0.2 * 0.2 / 2, 1e-12);
}

TEST(Energy, NoiseOfAFifthOfTheRadiusMovesASphereByLessThanATenth) {
  // as many points 0.2 inside the unit sphere as outside it
  std::vector<Vec3d> points;
  for (const Vec3d& p : scatteredPoints()) {
    const double norm = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    for (const double r : {0.8, 1.2})
      points.push_back({r * p.x / norm, r * p.y / norm, r * p.z / norm});
  }
  Energy energy({});
  energy.setPoints(points);
  const auto derivative = [&](double radius) {
    const double width = formats::widthForRadius(Kernel::Cauchy, 0.2, radius, 0.1);
    const auto at = [&](double w) { return energy.evaluate(std::vector<Blob>{{0, 0, 0, w}}); };
    return at(width + 1e-4) - at(width - 1e-4);
  };
  EXPECT_LT(derivative(0.98), 0);
  EXPECT_GT(derivative(1.07), 0);
}

TEST(Energy, EvennessIsTheSquaredDeviationOfTheWidths) {
  EnergyParameters p;
  p.evenWidth = 0.5;
  Energy energy(p);
  energy.setPoints(scatteredPoints());
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 0.4}, {1, 0, 0, 0.65}});
  EXPECT_NEAR(energy.terms().evenness, 0.04 + 0.09, 1e-12);
}

TEST(Energy, NormalisedDataTermIsThePlainOneWhereTheSlopeIsTheReference) {
  const std::vector<Blob> blobs = scatteredBlobs(0.6);
  Energy energy({});
  energy.setPoints(scatteredPoints());
  energy.evaluate(blobs);
  const double plain = energy.terms().data;
  EnergyParameters p;
  p.referenceSlope = energy.slope();
  energy.setParameters(p);
  energy.evaluate(blobs);
  EXPECT_DOUBLE_EQ(energy.terms().data, plain);
}

TEST(Energy, MeanCurvatureOfASphereIsTheInverseOfItsRadius) {
  Energy energy({});
  energy.setPoints(std::vector<Vec3d>{{0, 0, 2}});
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 1}});
  EXPECT_NEAR(energy.terms().curvature, 0.25, 1e-4);
}

TEST(Energy, MeanCurvatureOfATubeIsHalfTheInverseOfItsRadius) {
  std::vector<Blob> row;
  for (int i = -200; i <= 200; ++i) row.push_back({0.25 * i, 0, 0, 0.5});
  Energy energy({});
  energy.setPoints(std::vector<Vec3d>{{0, 0, 2}});
  energy.evaluate(row);
  EXPECT_NEAR(energy.terms().curvature, 1.0 / 16, 1e-3);
}

TEST(Energy, ASphereOfTheExpectedCurvatureCostsNothing) {
  EnergyParameters p;
  p.expectedCurvature = 0.5;
  Energy energy(p);
  energy.setPoints(std::vector<Vec3d>{{0, 0, 2}, {0, 2, 0}});
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 1}});
  EXPECT_NEAR(energy.meanCurvature(), 0.5, 1e-4);
  EXPECT_NEAR(energy.terms().curvature, 0, 1e-8);
}

TEST(Energy, MeanCurvatureIsThatOfThePoints) {
  Energy energy({});
  // spheres of radius 1 and 4 around the same blob: (1 + 1/4) / 2
  energy.setPoints(std::vector<Vec3d>{{0, 0, 1}, {0, 4, 0}});
  energy.evaluate(std::vector<Blob>{{0, 0, 0, 1}});
  EXPECT_NEAR(energy.meanCurvature(), 0.625, 1e-3);
}

TEST(Energy, CohesionIsLeastAtTwiceTheGeometricMeanOfTheWidths) {
  const auto at = [](double distance) {
    return cohesionResidual({0, 0, 0, 0.5}, {distance, 0, 0, 2}, 2).value;
  };
  EXPECT_NEAR(at(2), 0, 1e-15);
  EXPECT_NEAR(at(1), 63, 1e-12);                // sigma = 4: repelled
  EXPECT_NEAR(at(4), 1.0 / 64.0 - 1.0, 1e-15);  // sigma = 1/4: drawn together
}

TEST(Energy, CohesionTermIsThatOfTheThesisPlusOne) {
  const std::vector<Blob> blobs{{0, 0, 0, 1}, {1.5, 0, 0, 1}, {0, 3, 0, 1}};
  double expected = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == j) continue;
      const double dx = blobs[i].x - blobs[j].x, dy = blobs[i].y - blobs[j].y;
      const double cube = std::pow(4.0 / (dx * dx + dy * dy), 3);
      expected += cube * (cube - 2) / 6;
    }
  }
  Energy energy({});
  energy.setPoints(std::vector<Vec3d>{{0, 0, 1}});
  energy.evaluate(blobs);
  EXPECT_NEAR(energy.terms().cohesion, expected + 1, 1e-12);
}

TEST(Energy, CurvatureOfAFlatFieldIsZero) {
  // half way between two equal blobs the gradient vanishes
  Energy energy({});
  energy.setPoints(std::vector<Vec3d>{{0, 0, 0}});
  energy.evaluate(std::vector<Blob>{{-1, 0, 0, 1}, {1, 0, 0, 1}});
  EXPECT_EQ(energy.gradientSquared()[0], 0);
  EXPECT_EQ(energy.terms().curvature, 0);
}

}  // namespace
}  // namespace lumen::convert::fitting
