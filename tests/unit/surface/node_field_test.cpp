// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/node_field.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

using formats::Kernel;

formats::BlobbyModels randomModel(Kernel kernel) {
  formats::BlobbyModels models;
  models.kernel = kernel;
  models.kernelParameter = formats::defaultKernelParameter(kernel);
  models.offset = {0, 7};
  Random random(5);
  for (int j = 0; j < 7; ++j) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-2, 2)); };
    models.centre.push_back({coordinate(), coordinate(), coordinate()});
    models.width.push_back(static_cast<float>(random.uniform(0.3, 2)));
  }
  return models;
}

class NodeFieldOfKernel : public testing::TestWithParam<Kernel> {};

TEST_P(NodeFieldOfKernel, RowsAreBitwiseTheScalarReference) {
  const formats::BlobbyModels models = randomModel(GetParam());
  const NodeField field(models, 0);
  std::vector<double> row(61), reference(61);
  for (const double y : {-1.3, 0.0, 0.7, 9.0}) {
    field.sampleRow(-30, 0.17, y, 0.4, row);
    field.sampleRowReference(-30, 0.17, y, 0.4, reference);
    EXPECT_EQ(row, reference);
  }
}

TEST_P(NodeFieldOfKernel, AgreesWithTheModelsOwnEvaluation) {
  const formats::BlobbyModels models = randomModel(GetParam());
  const NodeField field(models, 0);
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
    const formats::FieldValue expected = formats::evaluateField(models, 0, {p.x(), p.y(), p.z()});
    const FieldSample found = field.sample(p);
    EXPECT_NEAR(found.f, expected.f, 1e-13);
    EXPECT_NEAR(field.value(p), expected.f, 1e-13);
    EXPECT_NEAR(found.gradient.x(), expected.gradient.x, 1e-13);
    EXPECT_NEAR(found.gradient.y(), expected.gradient.y, 1e-13);
    EXPECT_NEAR(found.gradient.z(), expected.gradient.z, 1e-13);
  }
}

TEST_P(NodeFieldOfKernel, FindsTheWallOnAnEdgeThatCrossesIt) {
  formats::BlobbyModels models = randomModel(GetParam());
  models.offset = {0, 1};
  models.centre.resize(1);
  models.width = {1.0F};
  const NodeField field(models, 0);
  const double radius =
      formats::isoRadius(models.kernel, models.kernelParameter, 1.0, models.isoLevel);
  const formats::Vec3f c = models.centre[0];
  for (const double start : {0.99, 0.9, 0.81}) {
    const Eigen::Vector3d centre(c.x, c.y, c.z);
    const Eigen::Vector3d a = centre + Eigen::Vector3d(start * radius, 0, 0),
                          b = a + Eigen::Vector3d(0.2 * radius, 0, 0);
    for (const bool inward : {false, true}) {
      const Eigen::Vector3d &from = inward ? b : a, &to = inward ? a : b;
      const double t = field.crossing(from, field.value(from), to, field.value(to));
      EXPECT_NEAR((from + t * (to - from) - centre).norm(), radius, 2e-5 * radius);
    }
  }
}

TEST_P(NodeFieldOfKernel, RangesLeaveOutNoInsideSampleAndNoneNextToOne) {
  const formats::BlobbyModels models = randomModel(GetParam());
  const NodeField field(models, 0);
  constexpr double kCell = 0.5;
  for (int z = -20; z <= 20; ++z)
    for (int y = -20; y <= 20; ++y)
      for (int x = -20; x <= 20; ++x) {
        if (field.value(kCell * Eigen::Vector3d(x, y, z)) <= models.isoLevel) continue;
        for (int d = 0; d < 9; ++d) {
          const auto range =
              field.rangeNearInside(kCell, kCell * (y + d % 3 - 1), kCell * (z + d / 3 - 1));
          EXPECT_LE(range.first, x - 1);
          EXPECT_GE(range.last, x + 1);
        }
      }
}

std::string kernelName(const testing::TestParamInfo<Kernel>& tested) {
  constexpr std::array<const char*, 4> kNames = {"Cauchy", "Gaussian", "Quartic", "SoftObject"};
  return kNames.at(static_cast<std::size_t>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Kernels, NodeFieldOfKernel,
                         testing::Values(Kernel::Cauchy, Kernel::Gaussian, Kernel::Quartic,
                                         Kernel::SoftObject),
                         kernelName);

}  // namespace
}  // namespace lumen::convert
