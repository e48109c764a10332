// SPDX-License-Identifier: Apache-2.0
// Surfaces of real vessels to cases and back: how far the case's surface is from the one it came from.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/statistics.h"
#include "converters/geometry/self_intersections.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/repair/repair.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "formats/case/reachability.h"

namespace lumen::convert {
namespace {

const std::string kData = LUMEN_SHARED_DATA;

struct Scores {
  double median = 0, most = 0, worst = 0;  ///< local radii; 99 %
  std::size_t branches = 0;
};

/// From the source's wall to the case's surface and back would need both to end alike: what is
/// measured is each vertex of the case's surface against the source.
Scores roundTrip(const std::string& file, MeshFormat format) {
  Progress progress;
  const MeshFile read = readMesh(kData + file, format);
  const RepairResult repaired = repairMesh(read.mesh, file, progress);
  MeshCase made = caseOfMesh(repaired.mesh, file, {}, {}, progress);
  fit(made.result, {}, progress);
  const TriangleTree source(repaired.mesh);
  for (const formats::Vec3f& c : made.result.tree.centre)
    EXPECT_TRUE(source.contains({c.x, c.y, c.z})) << c.x << " " << c.y << " " << c.z;
  std::vector<double> shares;
  for (const Float3& p : polygonise(made.result, {}, progress).surface.position) {
    const Eigen::Vector3d at(p[0], p[1], p[2]);
    double radius = 1e9, best = 1e9;
    for (std::size_t i = 0; i < made.result.tree.nodeCount(); ++i) {
      const auto& c = made.result.tree.centre[i];
      const double away = (Eigen::Vector3d(c.x, c.y, c.z) - at).norm();
      if (away >= best) continue;
      best = away;
      radius = made.result.tree.radius[i];
    }
    shares.push_back(source.nearest(at).distance / radius);
  }
  Scores scores;
  scores.median = median(shares);
  scores.most = nearestRank(shares, 0.99);
  scores.worst = *std::max_element(shares.begin(), shares.end());
  scores.branches = made.result.tree.branches.size();
  std::cout << file << ": median " << scores.median << ", 99 % " << scores.most << ", most "
            << scores.worst << " radii\n";
  return scores;
}

TEST(RealMeshes, TheAortaComesBack) {
  if (!std::filesystem::exists(kData + "/aorta/aorta-surface.stl"))
    GTEST_SKIP() << "no shared data";
  const Scores scores = roundTrip("/aorta/aorta-surface.stl", MeshFormat::Stl);
  EXPECT_EQ(scores.branches, 2U);
  EXPECT_LT(scores.median, 0.025);
}

TEST(RealMeshes, TheNeurovascularArteriesComeBack) {
  const std::string file = "/neurovascular/vessel_architecture_collision.obj";
  if (!std::filesystem::exists(kData + file)) GTEST_SKIP() << "no shared data";
  const Scores scores = roundTrip(file, MeshFormat::Obj);
  EXPECT_GE(scores.branches, 20U);
  // its tubes have about eight sides, whose chords lie up to 0.076 of the radius inside of a circle
  EXPECT_LT(scores.median, 0.076);
}

formats::Case aortaCase() {
  Progress progress;
  const MeshFile read = readMesh(kData + "/aorta/aorta-surface.stl", MeshFormat::Stl);
  const RepairResult repaired = repairMesh(read.mesh, "aorta", progress);
  MeshCase made = caseOfMesh(repaired.mesh, "aorta", {}, {}, progress);
  fit(made.result, {}, progress);
  return std::move(made.result);
}

TriangleMesh meshOf(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  for (const Float3& p : surface.position) mesh.position.emplace_back(p[0], p[1], p[2]);
  mesh.triangle = surface.triangle;
  return mesh;
}

// At the corners, and at points three times as dense as edges of half a millimetre.
double farthest(const TriangleMesh& from, const TriangleMesh& to) {
  const TriangleTree tree(to);
  double most = 0;
  for (const Triangle& t : from.triangle) {
    const Eigen::Vector3d &a = from.position[t[0]], u = from.position[t[1]] - a,
                          v = from.position[t[2]] - a;
    const int parts = std::clamp(static_cast<int>(std::max(u.norm(), v.norm()) / 0.17), 2, 60);
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j)
        most = std::max(most, tree.nearest(a + i * u / parts + j * v / parts).distance);
  }
  return most;
}

TEST(RealMeshes, TheAortasSurfaceStaysWithinTheErrorAsTrianglesAreDropped) {
  if (!std::filesystem::exists(kData + "/aorta/aorta-surface.stl"))
    GTEST_SKIP() << "no shared data";
  const formats::Case source = aortaCase();
  Progress progress;
  const TriangleMesh whole = meshOf(closedSurface(source, {}, progress).levels[0]);
  for (const double maxError : {0.05, 1.0}) {
    ClosedSurfaceOptions options;
    options.maxError = SurfaceError{.mm = maxError};
    options.levels = 2;
    const ClosedSurface made = closedSurface(source, options, progress);
    const TriangleMesh fewer = meshOf(made.levels[0]);
    EXPECT_LT(fewer.triangle.size(), whole.triangle.size() * 9 / 10);
    const FieldError& error = made.report.fieldError.value();
    EXPECT_LE(error.ninetieth, maxError);
    EXPECT_LE(error.beyond, error.places / 20);  // where models of neighbouring nodes disagree
    constexpr double kChords = 0.15;  // mm, of the other surface's: r/128 of the widest vessel
    const double stated = std::max(maxError, error.greatest);
    EXPECT_LE(farthest(fewer, whole), stated + kChords);
    EXPECT_LE(farthest(whole, fewer), stated + kChords);
    for (const SurfaceMesh& level : made.levels)
      EXPECT_EQ(selfIntersections(meshOf(level), 5).pairs.size(), 0U);
  }
}

TEST(RealMeshes, TheAortasWallIsAsThickAsAsked) {
  if (!std::filesystem::exists(kData + "/aorta/aorta-surface.stl"))
    GTEST_SKIP() << "no shared data";
  ClosedSurfaceOptions options;
  options.thickness = Length{0.5, 0};
  Progress progress;
  const SurfaceMesh solid = closedSurface(aortaCase(), options, progress).levels[0];
  const TriangleMesh mesh = meshOf(solid);
  EXPECT_EQ(selfIntersections(mesh, 5).pairs.size(), 0U);
  TriangleMesh inner{mesh.position, {}};
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    if (solid.group[t] == 0) inner.triangle.push_back(mesh.triangle[t]);
  const TriangleTree tree(inner);
  std::vector<double> shares;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (solid.group[t] != 1) continue;
    const Triangle& c = mesh.triangle[t];
    const Eigen::Vector3d middle =
        (mesh.position[c[0]] + mesh.position[c[1]] + mesh.position[c[2]]) / 3;
    shares.push_back(tree.nearest(middle).distance / 0.5);
  }
  // chords leave a circle by up to 3 % of the thickness, and the middle of a triangle is on one
  EXPECT_NEAR(median(shares), 1, 0.03);
  EXPECT_GT(nearestRank(shares, 0.01), 0.95);
  EXPECT_LT(nearestRank(shares, 0.99), 1.05);
}

}  // namespace
}  // namespace lumen::convert
