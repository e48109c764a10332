// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/decimate.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "closed_surface.h"
#include "converters/stages/surface/remesh.h"

namespace lumen::convert {
namespace {

using test::FieldOfCase;
using test::measureFacts;

CaseSurface fineTube(const FieldOfCase& of) {
  CaseSurface surface = test::closedSurface(of, 0.25, 0);
  test::cutFlat(surface, of, "inlet", {0.03, 0.05, 0.07}, {-1, 0, 0});
  test::cutFlat(surface, of, "outlet", {5.03, 0.05, 0.07}, {1, 0, 0});
  Progress progress;
  remesh(surface, of.sheet, {0.1}, progress);
  return surface;
}

void expectClosed(const CaseSurface& surface) {
  const test::MeshFacts facts = measureFacts(surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_GT(facts.volume, 0);
}

class DecimateTo : public testing::TestWithParam<double> {};

TEST_P(DecimateTo, StaysWithinTheErrorAndSaysIt) {
  const double maxError = GetParam();
  const FieldOfCase of(test::tubeCase(6));
  CaseSurface surface = fineTube(of);
  const std::size_t before = surface.mesh.triangle.size();
  Progress progress;
  const CaseSurface whole = surface;
  const double error = decimate(surface, of.sheet, {maxError}, progress);
  expectClosed(surface);
  EXPECT_LT(surface.mesh.triangle.size(), before / 2);
  EXPECT_LE(error, maxError);
  EXPECT_EQ(error, distanceBetween(surface, whole));
  // The wall is nearly a cylinder: its points, however they are taken, are no farther from it.
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (surface.group[t] != 0) continue;
    const auto& p = surface.mesh.position;
    const Triangle& c = surface.mesh.triangle[t];
    const Eigen::Vector3d inside = 0.2 * p[c[0]] + 0.3 * p[c[1]] + 0.5 * p[c[2]];
    EXPECT_NEAR(test::offAxis(inside), 1.0, 0.035 + 1.2 * maxError);
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, DecimateTo, testing::Values(0.01, 0.03, 0.1));

TEST(Decimate, KeepsGroupsAndTheirPlanes) {
  const FieldOfCase of(test::tubeCase(6));
  CaseSurface surface = fineTube(of);
  Progress progress;
  decimate(surface, of.sheet, {0.1}, progress);
  std::set<std::uint32_t> found(surface.group.begin(), surface.group.end());
  EXPECT_EQ(found, (std::set<std::uint32_t>{0, 1, 2}));
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (surface.group[t] == 0) continue;
    const SurfaceEnd& end = surface.ends[surface.group[t] - 1];
    for (const std::uint32_t v : surface.mesh.triangle[t])
      EXPECT_NEAR(end.normal.dot(surface.mesh.position[v] - end.centre), 0, 1e-9);
  }
}

TEST(LevelsOfDetail, HaveAQuarterOfTheTrianglesEach) {
  const FieldOfCase of(test::tubeCase(6));
  Progress progress;
  std::vector<DetailLevel> levels{{fineTube(of), -1}};
  addCoarserLevels(levels, 3, of.sheet, progress);
  ASSERT_EQ(levels.size(), 3U);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    expectClosed(levels[i].surface);
    if (i == 0) continue;
    const auto triangles = static_cast<double>(levels[i].surface.mesh.triangle.size());
    const auto finer = static_cast<double>(levels[i - 1].surface.mesh.triangle.size());
    EXPECT_NEAR(triangles / finer, 0.25, 0.02);
    const auto error = [&](std::size_t level) {
      return distanceBetween(levels[level].surface, levels[0].surface);
    };
    EXPECT_GT(error(i), error(i - 1));
    EXPECT_LT(error(i), 0.3);
  }
}

}  // namespace
}  // namespace lumen::convert
