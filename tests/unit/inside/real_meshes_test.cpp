// SPDX-License-Identifier: Apache-2.0
// Surfaces of real vessels to cases and back: how far the case's surface is from the one it came from.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/common/statistics.h"
#include "converters/fitting/fit.h"
#include "converters/inside/case_of_mesh.h"
#include "converters/mesh/mesh_file.h"
#include "converters/mesh/repair.h"
#include "converters/mesh/triangle_tree.h"
#include "converters/surface/polygonise.h"
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

}  // namespace
}  // namespace lumen::convert
