// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/simplify.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "closed_cases.h"
#include "closed_surface.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/extract.h"

namespace lumen::convert {
namespace {

using test::FieldOfCase;

CaseSurface rawSurface(const FieldOfCase& of, const LatticeEdge& edge) {
  Progress silent;
  ExtractionReport report;
  CaseSurface surface = extractSurface(of.sheet, edge, report, silent);
  cutEnds(surface, of.sheet, silent);
  return surface;
}

struct Simplified {
  CaseSurface surface;
  SimplifyReport report;
};

Simplified simplified(const FieldOfCase& of, const SurfaceError& allowed,
                      std::size_t triangles = 0) {
  Progress silent;
  const SurfaceError chords{kChordShare * allowed.mm};
  Simplified made{rawSurface(of, {1.2, chords}), {}};
  made.report = simplifyToField(made.surface, of.sheet, allowed, triangles, silent);
  return made;
}

/// The greatest distance from the field of points all over the wall's triangles, in radii of 1 mm.
double farthestOf(const FieldOfCase& of, const CaseSurface& surface) {
  constexpr int kParts = 6;
  double farthest = 0;
  for (std::size_t f = 0; f < surface.mesh.triangle.size(); ++f) {
    if (surface.group[f] != 0) continue;
    const Triangle& t = surface.mesh.triangle[f];
    const auto& p = surface.mesh.position;
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j) {
        const double u = double(i) / kParts, v = double(j) / kParts;
        const Eigen::Vector3d at = p[t[0]] + u * (p[t[1]] - p[t[0]]) + v * (p[t[2]] - p[t[0]]);
        farthest = std::max(farthest, std::abs(of.sheet.at(at, surface.node[t[0]]).distance));
      }
  }
  return farthest;
}

void expectProof(const CaseSurface& surface) {
  const test::MeshFacts facts = measureFacts(surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_EQ(selfIntersections(surface.mesh).pairs.size(), 0U);
}

class SimplifyTo : public testing::TestWithParam<double> {};

TEST_P(SimplifyTo, LiesWithinTheErrorAllOverItsTriangles) {
  const double allowed = GetParam();
  for (const bool isFork : {false, true}) {
    const FieldOfCase of(isFork ? test::forkCase() : test::tubeCase(12));
    const Simplified made = simplified(of, {.mm = allowed});
    expectProof(made.surface);
    EXPECT_EQ(made.report.crossings, 0U);
    EXPECT_LE(made.report.error.beyond, made.report.error.places / 200) << isFork;
    EXPECT_LE(made.report.error.greatest, 2 * allowed);  // at the crease of a fork
    EXPECT_LE(made.report.error.ninetieth, made.report.error.greatest);
    EXPECT_LE(farthestOf(of, made.surface), 2.5 * allowed) << isFork;
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, SimplifyTo, testing::Values(0.01, 0.03, 0.1));

TEST(Simplify, LeavesFewTriangles) {
  const FieldOfCase of(test::tubeCase(12));
  const CaseSurface raw = rawSurface(of, 0.5);
  const std::size_t coarse = simplified(of, {.mm = 0.06}).surface.mesh.triangle.size();
  const std::size_t fine = simplified(of, {.mm = 0.02}).surface.mesh.triangle.size();
  EXPECT_LT(coarse, raw.mesh.triangle.size() / 5);
  EXPECT_GT(fine, 3 * coarse / 2);
  // a polygon within 0.06 radii of a circle, half of it outside, has seven sides
  EXPECT_LT(coarse, 300U);
}

TEST(Simplify, EnclosesTheVolumeOfTheField) {
  const FieldOfCase of(test::tubeCase(12));
  Progress silent;
  ExtractionReport report;
  CaseSurface fine = extractSurface(of.sheet, 0.25, report, silent);
  cutEnds(fine, of.sheet, silent);
  const double volume = signedVolume(fine.mesh);
  // corners on the wall would enclose 4 % less
  EXPECT_NEAR(signedVolume(simplified(of, {.mm = 0.03}).surface.mesh) / volume, 1, 0.012);
  EXPECT_NEAR(signedVolume(simplified(of, {.mm = 0.06}).surface.mesh) / volume, 1, 0.02);
}

TEST(Simplify, KeepsABudgetAndStatesItsError) {
  const FieldOfCase of(test::forkCase());
  for (const std::size_t triangles : {300U, 800U}) {
    const Simplified made = simplified(of, {.mm = INFINITY}, triangles);
    expectProof(made.surface);
    const auto count = static_cast<double>(made.surface.mesh.triangle.size());
    EXPECT_LE(count, static_cast<double>(triangles));
    EXPECT_GE(count, 0.98 * static_cast<double>(triangles));
    EXPECT_GT(made.report.error.greatest, 0);
    EXPECT_LT(made.report.error.greatest, 0.5);
  }
}

TEST(Simplify, KeepsGroupsRimsAndPlanes) {
  const FieldOfCase of(test::tubeCase(12));
  const Simplified made = simplified(of, {.mm = 0.06});
  const CaseSurface& surface = made.surface;
  ASSERT_EQ(surface.ends.size(), 2U);
  for (const SurfaceEnd& end : surface.ends) {
    std::size_t faces = 0;
    for (std::size_t f = 0; f < surface.group.size(); ++f) {
      if (surface.group[f] != end.group) continue;
      ++faces;
      for (const std::uint32_t v : surface.mesh.triangle[f])
        EXPECT_NEAR(end.normal.dot(surface.mesh.position[v] - end.centre), 0, 1e-5);
    }
    EXPECT_GE(faces, 6U);  // of a rim of eight edges
  }
  for (const auto& rim : convert::findRims(surface)) EXPECT_GE(rim.size(), 8U);
}

TEST(Simplify, IsTheSameOnAnyNumberOfThreads) {
  const FieldOfCase of(test::forkCase());
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return simplified(of, {.mm = 0.03}).surface.mesh;
  };
  const TriangleMesh one = run(1), four = run(4);
  EXPECT_EQ(one.triangle, four.triangle);
  EXPECT_EQ(one.position, four.position);
}

}  // namespace
}  // namespace lumen::convert
