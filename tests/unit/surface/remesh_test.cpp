// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "closed_surface.h"
#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/remesh/remesh_moves.h"
#include "converters/stages/surface/remesh/remesh_pieces.h"
#include "converters/stages/surface/simplify/simplify.h"

namespace lumen::convert {
namespace {

using test::FieldOfCase;
using test::measureFacts;

// A wide vessel, and a thin one that leaves it at a right angle.
formats::Case forkCase() {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "wide", test::straightPath({0.03, 0.05, 0.07}, {0.5, 0, 0}, 11), 1.0,
                  1.0);
  test::addVessel(source, "thin", test::straightPath({2.53, 0.05, 0.77}, {0.02, 0.05, 0.2}, 14),
                  0.3, 0.3, 5);
  test::addModels(source);
  return source;
}

CaseSurface roughFork(const FieldOfCase& of) {
  return test::closedSurface(of, 0.15, 0.3);
}

void expectClosed(const CaseSurface& surface, std::ptrdiff_t euler) {
  const test::MeshFacts facts = measureFacts(surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, euler);
  EXPECT_GT(facts.volume, 0);
  TriangleMesh copy = surface.mesh;
  separateFans(copy);
  EXPECT_EQ(copy.position.size(), surface.mesh.position.size()) << "a vertex has two fans";
  EXPECT_EQ(surface.node.size(), surface.mesh.position.size());
  EXPECT_EQ(surface.group.size(), surface.mesh.triangle.size());
}

TriangleQuality measureQuality(const CaseSurface& surface, const FieldOfCase& of,
                               const EdgeLength& edge = {}) {
  return triangleQuality(surface.mesh, targetLengths(surface, of.sheet, edge));
}

void expectForUse(const TriangleQuality& quality) {
  EXPECT_EQ(quality.sharp, 0U);
  EXPECT_GE(quality.leastAngle, 15);
  EXPECT_GE(quality.medianAngle, 45);
}

TEST(Remesh, GivesAForkTrianglesForUse) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  EXPECT_GT(measureQuality(surface, of).sharp, 100U) << "the input is not rough";
  Progress progress;
  const RemeshReport report = remesh(surface, of.sheet, {}, progress);
  expectClosed(surface, 2);
  expectForUse(measureQuality(surface, of));
  EXPECT_NEAR(measureQuality(surface, of).edgeMedian, 1, 0.15);
  EXPECT_EQ(report.sharp, 0U);
  EXPECT_EQ(report.offField, 0U);
}

TEST(Remesh, VerticesLieOnTheFieldAndLookOutOfIt) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  Progress progress;
  remesh(surface, of.sheet, {}, progress);
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    const SeparatedSample at = of.sheet.at(surface.mesh.position[v], surface.node[v]);
    EXPECT_LT(std::abs(at.distance), 2e-4 * of.sheet.radius(at.node));
  }
  for (const Triangle& t : surface.mesh.triangle) {
    const auto& p = surface.mesh.position;
    const Eigen::Vector3d normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
    const Eigen::Vector3d middle = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
    EXPECT_GT(normal.dot(of.sheet.at(middle, surface.node[t[0]]).gradient), 0.5);
  }
}

// Edges on the thin branch follow its own radius, and grow gently into those of the wide one.
TEST(Remesh, EdgesFollowTheRadiusAndGrowGently) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  Progress progress;
  remesh(surface, of.sheet, {}, progress);
  double thin = 0, wide = 0;
  std::size_t thins = 0, wides = 0;
  for (const Triangle& t : surface.mesh.triangle) {
    std::array<double, 3> length{};
    for (std::size_t i = 0; i < 3; ++i)
      length[i] = (surface.mesh.position[t[i]] - surface.mesh.position[t[(i + 1) % 3]]).norm();
    EXPECT_LT(std::max({length[0], length[1], length[2]}),
              4 * std::min({length[0], length[1], length[2]}));
    const double z = surface.mesh.position[t[0]].z(), x = surface.mesh.position[t[0]].x();
    if (z > 2.2) thin += length[0], ++thins;
    if (z < 0.5 && x > 0 && x < 5) wide += length[0], ++wides;
  }
  ASSERT_GT(thins, 100U);
  ASSERT_GT(wides, 100U);
  EXPECT_NEAR(thin / static_cast<double>(thins), 0.25 * 0.3, 0.2 * 0.25 * 0.3);
  EXPECT_NEAR(wide / static_cast<double>(wides), 0.25, 0.2 * 0.25);
}

TEST(TargetLengths, GrowByAQuarterOfTheWayAtMost) {
  const FieldOfCase of(forkCase());
  const CaseSurface surface = roughFork(of);
  const std::vector<double> target = targetLengths(surface, of.sheet, {});
  for (const Triangle& t : surface.mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      const double separation = (surface.mesh.position[v] - surface.mesh.position[w]).norm();
      EXPECT_LE(target[v], target[w] + 0.25 * separation + 1e-12);
    }
}

// A circumference of 2 pi 0.3 mm is 1.88 mm: eight edges of 0.24 mm, whatever the least length.
TEST(TargetLengths, ALeastLengthLeavesEightEdgesAroundAThinVessel) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  Progress progress;
  const EdgeLength coarse{0.25, 0.6};
  remesh(surface, of.sheet, coarse, progress);
  expectClosed(surface, 2);
  // Edges that cross a plane normal to the thin branch each lie in two triangles.
  std::size_t crossing = 0;
  for (const Triangle& t : surface.mesh.triangle) {
    bool above = false, below = false;
    for (const std::uint32_t v : t) (surface.mesh.position[v].z() > 2.7 ? above : below) = true;
    if (above && below) ++crossing;
  }
  EXPECT_GE(crossing, 16U) << "triangles around, two for each edge";
  const std::vector<double> target = targetLengths(surface, of.sheet, coarse);
  EXPECT_NEAR(*std::ranges::max_element(target), 0.6, 1e-9);
}

CaseSurface cutTube(const FieldOfCase& of) {
  CaseSurface surface = test::closedSurface(of, 0.25, 0.3);
  test::cutFlat(surface, of, "inlet", {0.03, 0.05, 0.07}, {-1, 0, 0});
  test::cutFlat(surface, of, "outlet", {5.03, 0.05, 0.07}, Eigen::Vector3d(1, 0.2, 0).normalized());
  return surface;
}

// Vertices of triangles of two groups, by group.
std::map<std::uint32_t, std::set<std::uint32_t>> findRims(const CaseSurface& surface) {
  std::vector<std::set<std::uint32_t>> groups(surface.node.size());
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    for (const std::uint32_t v : surface.mesh.triangle[t]) groups[v].insert(surface.group[t]);
  std::map<std::uint32_t, std::set<std::uint32_t>> rims;
  for (std::uint32_t v = 0; v < groups.size(); ++v)
    if (groups[v].size() > 1) rims[*groups[v].rbegin()].insert(v);
  return rims;
}

TEST(Remesh, KeepsRimsAndThePlanesOfEnds) {
  const FieldOfCase of(test::tubeCase(6));
  CaseSurface surface = cutTube(of);
  expectClosed(surface, 2);
  Progress progress;
  const RemeshReport report = remesh(surface, of.sheet, {}, progress);
  expectClosed(surface, 2);
  expectForUse(measureQuality(surface, of));
  EXPECT_EQ(report.offField, 0U);
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (surface.group[t] == 0) continue;
    const SurfaceEnd& end = surface.ends[surface.group[t] - 1];
    for (const std::uint32_t v : surface.mesh.triangle[t])
      EXPECT_NEAR(end.normal.dot(surface.mesh.position[v] - end.centre), 0, 1e-9);
  }
  const auto rims = findRims(surface);
  ASSERT_EQ(rims.size(), 2U);
  for (const auto& [group, vertices] : rims) {
    EXPECT_NEAR(static_cast<double>(vertices.size()), 2 * std::numbers::pi / 0.25, 4);
    for (const std::uint32_t v : vertices) {
      const SeparatedSample at = of.sheet.at(surface.mesh.position[v], surface.node[v]);
      EXPECT_LT(std::abs(at.distance), 2e-4);
    }
  }
  // The inlet is a regular polygon, but for what its edges differ.
  const auto& p = surface.mesh.position;
  double area = 0, radius = 0;
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (surface.group[t] != 1) continue;
    const Triangle& c = surface.mesh.triangle[t];
    area += (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).norm() / 2;
  }
  const auto& inlet = rims.at(1);
  const auto n = static_cast<double>(inlet.size());
  for (const std::uint32_t v : inlet) radius += (p[v] - surface.ends[0].centre).norm() / n;
  const double polygon = n / 2 * radius * radius * std::sin(2 * std::numbers::pi / n);
  EXPECT_NEAR(area, polygon, 0.005 * polygon);
}

formats::Case twoTubes(double apart) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "left", test::straightPath({0, 0, 0}, {0.5, 0, 0}, 9), 1.0, 1.0);
  test::addVessel(source, "right", test::straightPath({0.01, apart, 0.02}, {0.5, 0, 0}, 9), 1.0,
                  1.0);
  test::addModels(source);
  return source;
}

// Cursors are carried along and never found anew: each tube stays its own, 0.01 mm beside another.
TEST(Remesh, VesselsThatTouchKeepTheirNodes) {
  const FieldOfCase of(twoTubes(2.05), 0.02);
  CaseSurface surface = test::closedSurface(of, 0.08, 0.3);
  expectClosed(surface, 4);
  Progress progress;
  remesh(surface, of.sheet, {}, progress);
  expectClosed(surface, 4);
  expectForUse(measureQuality(surface, of));
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    const bool isRight = surface.mesh.position[v].y() > 1.025;
    EXPECT_EQ(of.source.tree.branch[surface.node[v]], isRight ? 1U : 0U);
  }
}

// Long enough for several pieces, whose seams must leave no trace and no dependence on threads.
TEST(Remesh, ThreadsGiveTheSameBytes) {
  const FieldOfCase of(test::tubeCase(24));
  const CaseSurface rough = test::closedSurface(of, 0.15, 0.3);
  ASSERT_GT(rough.mesh.triangle.size(), 10000U) << "one piece alone shows nothing";
  std::array<CaseSurface, 2> results{rough, rough};
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Progress progress;
    remesh(results[threads - 1], of.sheet, {}, progress);
  }
  EXPECT_EQ(results[0].mesh.triangle, results[1].mesh.triangle);
  EXPECT_EQ(results[0].mesh.position, results[1].mesh.position);
  EXPECT_EQ(results[0].node, results[1].node);
  expectClosed(results[0], 2);
  expectForUse(measureQuality(results[0], of));
}

TEST(Remesh, StopsWhenCancelled) {
  const FieldOfCase of(test::tubeCase(3));
  CaseSurface surface = test::closedSurface(of, 0.3, 0);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(remesh(surface, of.sheet, {}, progress), Error);
}

TEST(Remesh, APassOverAPieceStopsWhenCancelled) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  Progress progress;
  const PieceRules rules = pieceRules(surface, of.sheet, progress);
  RemeshState state{surface, std::vector<double>(surface.mesh.position.size(), 0.005), {}, {}, {},
                    {}};
  state.gradient.assign(surface.mesh.position.size(), Eigen::Vector3d::Zero());
  state.isSeparated.assign(surface.mesh.position.size(), 0);
  state.isOffField.assign(surface.mesh.position.size(), 0);
  state.isBoundary.assign(surface.mesh.position.size(), 0);
  TriangleList all(surface.mesh.triangle.size());
  std::iota(all.begin(), all.end(), 0U);
  RemeshMesh mesh(cutOut(state, all), rules);
  progress.cancel();
  EXPECT_THROW(splitLong(mesh), Error);
}

TEST(TriangleQuality, KnowsTheAnglesOfKnownTriangles) {
  TriangleMesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0, 0.1, 0}};
  mesh.triangle = {{0, 1, 2}};
  EXPECT_NEAR(triangleQuality(mesh).medianAngle, 60, 1e-9);
  mesh.triangle.push_back({0, 1, 3});
  const TriangleQuality two = triangleQuality(mesh);
  EXPECT_NEAR(two.leastAngle, std::atan(0.1) * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(two.sharp, 1U);
}

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
  const double error = simplify(surface, {maxError}, progress);
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
  simplify(surface, {0.1}, progress);
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
  addCoarserLevels(levels, 3, progress);
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
