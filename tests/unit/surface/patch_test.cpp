// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/patch.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../mesh/mesh_facts.h"
#include "converters/base/random.h"
#include "converters/stages/surface/patches/node_field.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

// The tetrahedron with corners at the origin and at 1 on each axis: volume 1/6.
TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(Clip, LeavesTheInnerPartWithItsNewVerticesOnThePlane) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 0.5}, 0);
  const test::MeshFacts facts = test::measureFacts(patch);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.boundary.size(), 3U);  // a triangle of the tetrahedron's cross-section
  for (const std::uint32_t v : facts.boundary) EXPECT_EQ(patch.position[v].x(), 0.5);
  // The outline is shared: three vertices at x = 0 and three at x = 0.5, nothing twice.
  EXPECT_EQ(patch.position.size(), 6U);
  // Surface: the face x = 0 is 1/2; three quarters remain of the two faces of 1/2 and of the
  // slanted one.
  EXPECT_NEAR(facts.area, 0.5 + 0.75 * (0.5 + 0.5 + std::sqrt(3.0) / 2), 1e-12);
}

TEST(Clip, KeepsAPatchThatLiesInside) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 1}, 0);
  EXPECT_EQ(patch.position.size(), 4U);
  EXPECT_EQ(patch.triangle.size(), 4U);
}

TEST(Clip, DropsAPatchThatLiesOutside) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), -0.5}, 0);
  EXPECT_TRUE(patch.position.empty());
  EXPECT_TRUE(patch.triangle.empty());
}

TEST(Clip, AVertexWithinTheSnapIsOnThePlane) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 0.999}, 0.01);
  EXPECT_EQ(patch.triangle.size(), 4U);  // uncut
}

TEST(DropFarParts, KeepsAPartWithOneVertexNearEnough) {
  TriangleMesh patch = tetrahedron();
  dropFarParts(patch, {-2, 0, 0}, 2);  // the origin is 2 away, the others farther
  EXPECT_EQ(patch.triangle.size(), 4U);
  dropFarParts(patch, {-2, 0, 0}, 1.9);
  EXPECT_TRUE(patch.triangle.empty());
  EXPECT_TRUE(patch.position.empty());
}

TEST(RoundToFloat, JoinsVerticesThatBecomeOneAndKeepsTheSurfaceClosed) {
  // Vertex 4 splits the edge from 1 to 2 and lies 1e-12 from vertex 1, a thousandth of what a float
  // resolves.
  TriangleMesh patch{{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {2 - 1e-12, 1 + 1e-12, 1}},
                     {{0, 2, 4}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 4, 3}, {4, 2, 3}}};
  EXPECT_EQ(test::measureFacts(patch).boundaryEdges, 0U);
  roundToFloat(patch);
  EXPECT_EQ(patch.position.size(), 4U);
  EXPECT_EQ(patch.triangle.size(), 4U);
  EXPECT_EQ(test::measureFacts(patch).boundaryEdges, 0U);
}

TEST(SeparateFans, SplitsAVertexWhereTwoSurfacesTouch) {
  TriangleMesh patch = tetrahedron();
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, -1)})
    patch.position.push_back(p);
  for (const Triangle& t :
       {Triangle{0, 4, 5}, Triangle{0, 6, 4}, Triangle{0, 5, 6}, Triangle{4, 6, 5}})
    patch.triangle.push_back(t);
  separateFans(patch);
  ASSERT_EQ(patch.position.size(), 8U);
  EXPECT_EQ(patch.position[7], Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(test::measureFacts(patch).euler, 4);  // two spheres
}

TEST(SeparateFans, CutsAnEdgeOfFourTriangles) {
  // Two tetrahedra on either side of a common edge from 0 to 3.
  TriangleMesh patch = tetrahedron();
  patch.position.push_back({-1, 0, 0});
  patch.position.push_back({0, -1, 0});
  for (const Triangle& t :
       {Triangle{0, 5, 4}, Triangle{0, 4, 3}, Triangle{0, 3, 5}, Triangle{4, 5, 3}})
    patch.triangle.push_back(t);
  EXPECT_EQ(test::measureFacts(patch).badEdges, 1U);
  separateFans(patch);
  EXPECT_EQ(test::measureFacts(patch).badEdges, 0U);
}

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
