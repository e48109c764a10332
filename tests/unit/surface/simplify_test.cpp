// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/simplify.h"

#include <algorithm>
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
#include "converters/stages/surface/remesh/mend_crossings.h"
#include "converters/stages/surface/simplify/close_sheets.h"
#include "converters/stages/surface/simplify/collapsing_mesh.h"

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
  const test::MeshFacts facts = test::measureFacts(surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_EQ(selfIntersections(surface.mesh).pairs.size(), 0U);
  // as a file has them, so that none appears in it
  std::size_t others = 0;
  for (const Eigen::Vector3d& place : surface.mesh.position)
    for (const double x : place) others += static_cast<double>(static_cast<float>(x)) == x ? 0 : 1;
  EXPECT_EQ(others, 0U);
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

/// Two tubes whose walls touch along 8 mm, 0.02 mm apart.
formats::Case kissCase() {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  test::addVessel(result, "one", test::straightPath({0, 0, 0}, {1, 0, 0}, 10), 1.0, 1.0);
  test::addVessel(result, "other", test::straightPath({0, 2, 0}, {1, 0, 0}, 10), 1.0, 1.0);
  test::addModels(result);
  return result;
}

TEST(Simplify, KeepsTouchingVesselsApart) {
  const FieldOfCase of(kissCase());
  for (const std::size_t triangles : {0U, 300U, 1000U}) {
    const SurfaceError allowed{.mm = triangles > 0 ? INFINITY : 0.1};
    const Simplified made = simplified(of, allowed, triangles);
    EXPECT_EQ(made.report.crossings, 0U);
    EXPECT_EQ(selfIntersections(made.surface.mesh).pairs.size(), 0U);
    EXPECT_EQ(test::measureFacts(made.surface.mesh).euler, 4);
    if (triangles > 0)
      EXPECT_LE(made.surface.mesh.triangle.size(), triangles);
    else
      EXPECT_LT(made.surface.mesh.triangle.size(), 2000U);
  }
}

/// A square of 20 by 20 edges of 0.1 mm in a plane of constant z.
void addSquare(TriangleMesh& mesh, double z, bool isUp) {
  constexpr std::uint32_t kSide = 21;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    mesh.position.emplace_back(0.1 * (i % kSide), 0.1 * (i / kSide), z);
  for (std::uint32_t i = 0; i + kSide < kSide * kSide; ++i) {
    if (i % kSide == kSide - 1) continue;
    const std::uint32_t a = first + i, b = a + 1, c = a + kSide, d = c + 1;
    mesh.triangle.push_back(isUp ? Triangle{a, b, d} : Triangle{a, d, b});
    mesh.triangle.push_back(isUp ? Triangle{a, d, c} : Triangle{a, c, d});
  }
}

std::size_t countClose(const TriangleMesh& mesh, const std::vector<double>& reach) {
  const std::vector<float> share = closeVertices(mesh, reach);
  return static_cast<std::size_t>(
      std::count_if(share.begin(), share.end(), [](float of) { return of < 1; }));
}

TEST(CloseVertices, FaceEachOther) {
  const auto count = [](double apart, bool doFace, double reach) {
    TriangleMesh mesh;
    addSquare(mesh, 0, true);
    addSquare(mesh, apart, !doFace);
    return countClose(mesh, std::vector<double>(mesh.position.size(), reach));
  };
  EXPECT_EQ(count(0.3, true, 0.31), 2U * 21 * 21);
  EXPECT_EQ(count(0.3, true, 0.29), 0U);
  EXPECT_EQ(count(0.3, false, 0.5), 0U);
}

TEST(CloseVertices, StateTheirDistanceAsAShare) {
  TriangleMesh mesh;
  addSquare(mesh, 0, true);
  addSquare(mesh, 0.3, false);
  const std::vector<double> reach(mesh.position.size(), 0.4);
  for (const float share : closeVertices(mesh, reach)) EXPECT_NEAR(share, 0.75F, 1e-6F);
  mesh.position.back().z() = 1;  // no other one faces it
  EXPECT_EQ(closeVertices(mesh, reach).back(), kNotClose);
}

TEST(CollapsingMesh, LooksAtTrianglesThatAreCloseWithinAShare) {
  const FieldOfCase of(test::tubeCase(4));
  Progress silent;
  ExtractionReport report;
  CaseSurface surface = extractSurface(of.sheet, 1, report, silent);
  std::vector<float> closeFrom(surface.mesh.position.size(), kNotClose);
  const std::uint32_t one = surface.mesh.triangle[0][0];
  closeFrom[one] = 0.5F;
  CollapsingMesh mesh(surface, closeFrom);
  const auto count = [&](double share) {
    mesh.lookWithin(share);
    return std::count(mesh.isClose().begin(), mesh.isClose().end(), 1);
  };
  EXPECT_EQ(count(0.49), 0);
  mesh.beginPass();
  EXPECT_EQ(count(0.51), static_cast<std::ptrdiff_t>(mesh.fan(one).size()));
}

TEST(SmoothCrossings, PullsAFoldStraight) {
  const FieldOfCase of(test::tubeCase(4));
  Progress silent;
  ExtractionReport report;
  CaseSurface surface = extractSurface(of.sheet, 1, report, silent);
  const Eigen::Vector3d place = surface.mesh.position[0];
  surface.mesh.position[0] = 2 * surface.mesh.position.back() - place;  // through the tube
  SelfIntersections found = selfIntersections(surface.mesh);
  ASSERT_FALSE(found.pairs.empty());
  EXPECT_GT(smoothCrossings(surface, found, silent), 0U);
  EXPECT_TRUE(found.pairs.empty());
  EXPECT_TRUE(selfIntersections(surface.mesh).pairs.empty());
  EXPECT_LT((surface.mesh.position[0] - place).norm(), 1);
}

TEST(CloseVertices, CountTheLongerReachOfBoth) {
  TriangleMesh mesh;
  addSquare(mesh, 0, true);
  const std::size_t one = mesh.position.size();
  addSquare(mesh, 0.3, false);
  std::vector<double> reach(mesh.position.size(), 0.1);
  std::fill(reach.begin(), reach.begin() + static_cast<std::ptrdiff_t>(one), 0.4);
  EXPECT_EQ(countClose(mesh, reach), mesh.position.size());
}

TEST(CloseVertices, AreThoseAtFolds) {
  TriangleMesh mesh;
  addSquare(mesh, 0, true);
  mesh.position[5 * 21 + 7].z() = 0.05;
  EXPECT_EQ(countClose(mesh, std::vector<double>(mesh.position.size(), 0.2)), 0U);
  mesh.position[5 * 21 + 7].z() = 1;
  const std::size_t atSpike = countClose(mesh, std::vector<double>(mesh.position.size(), 0.2));
  EXPECT_GE(atSpike, 7U);
  EXPECT_LE(atSpike, 40U);
}

TEST(CrossingsOfChanged, AreThoseOfBothMasks) {
  TriangleMesh mesh;
  addSquare(mesh, 0, true);
  mesh.position.insert(mesh.position.end(), {{0.31, 0.32, -1}, {0.33, 0.32, 1}, {0.32, 0.36, 1}});
  const auto first = static_cast<std::uint32_t>(mesh.position.size() - 3);
  mesh.triangle.push_back({first, first + 1, first + 2});
  const std::size_t crossing = selfIntersections(mesh).pairs.size();
  ASSERT_GT(crossing, 0U);
  const Progress silent;
  const std::vector<std::uint8_t> all(mesh.triangle.size(), 1), none(mesh.triangle.size(), 0);
  std::vector<std::uint8_t> last = none, others = all;
  last.back() = 1;
  others.back() = 0;
  EXPECT_EQ(crossingsOfChanged(mesh, all, all, silent).size(), crossing);
  EXPECT_EQ(crossingsOfChanged(mesh, last, all, silent).size(), crossing);
  EXPECT_EQ(crossingsOfChanged(mesh, others, all, silent).size(), crossing);
  EXPECT_EQ(crossingsOfChanged(mesh, none, all, silent).size(), 0U);
  EXPECT_EQ(crossingsOfChanged(mesh, all, others, silent).size(), 0U);
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
