// SPDX-License-Identifier: Apache-2.0
// Phantoms of trees from files.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"
#include "converters/stages/phantom/smooth_chain.h"
#include "formats/case/case_file.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Two trees far from the origin: a trunk of 2 mm in radius along x with a narrow vessel, one that is
// too short, and one on the narrow one; and a lone trunk.
const char* const kTrees =
    "1 0 -40 10 5 2 -1\n2 0 -35 10 5 2 1\n3 0 -30 10 5 2 2\n4 0 -25 10 5 2 3\n5 0 -20 10 5 2 4\n"
    "6 0 -30 14 5 0.5 3\n7 0 -30 18 5 0.5 6\n8 0 -30 22 5 0.5 7\n"
    "9 0 -35 10 9 1 2\n"
    "10 0 -28 20 5 0.4 7\n11 0 -26 22 5 0.4 10\n12 0 -24 24 5 0.4 11\n"
    "20 0 -40 30 5 1 -1\n21 0 -30 30 5 1 20\n";

struct TreeFile {
  explicit TreeFile(const std::string& text)
      : path(std::filesystem::path(testing::TempDir()) / "phantom-tree.swc") {
    std::ofstream(path) << text;
  }
  ~TreeFile() { std::filesystem::remove(path); }
  TreeFile(const TreeFile&) = delete;
  TreeFile& operator=(const TreeFile&) = delete;
  std::filesystem::path path;
};

PhantomOptions optionsOf(const TreeFile& file, double voxel) {
  PhantomOptions options;
  options.tree = file.path;
  options.voxel = voxel;
  options.noise = options.bias = options.psf = 0;
  return options;
}

Phantom make(const PhantomOptions& options) {
  Progress progress;
  return makePhantom(options, progress);
}

std::string refusal(const PhantomOptions& options) {
  try {
    make(options);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(SmoothVessels, KeepBothEndsAndBeginOnTheParentsCurve) {
  const std::vector<SmoothVessel> vessels = smoothVessels(parseSwc(kTrees, "t"), 0.1);
  ASSERT_EQ(vessels.size(), 5U);
  EXPECT_EQ(vessels[0].path.front().position, Vector3d(-40, 10, 5));
  EXPECT_EQ(vessels[0].path.back().position, Vector3d(-20, 10, 5));
  for (const SmoothVessel& vessel : vessels) {
    if (vessel.parent < 0) continue;
    double nearest = 1e9;
    for (const PathPoint& p : vessels[static_cast<std::size_t>(vessel.parent)].path)
      nearest = std::min(nearest, (p.position - vessel.path.front().position).norm());
    EXPECT_LT(nearest, 1e-9);
    EXPECT_LT(vessel.path.front().radius, 1.001);
  }
}

TEST(SmoothVessels, StepsOfATraceGoAndItsLengthComesDownToTheVessels) {
  // a straight vessel, traced on voxels that it crosses by steps of one to either side
  std::string text;
  for (int i = 1; i <= 40; ++i)
    text += std::to_string(i) + " 0 " + std::to_string(i) + " " + std::to_string(0.6 * (i % 2)) +
            " 0 1 " + (i == 1 ? "-1" : std::to_string(i - 1)) + "\n";
  const Path path = smoothVessels(parseSwc(text, "t"), 0.05)[0].path;
  for (const PathPoint& p : path)
    if (p.position.x() > 6 && p.position.x() < 35) {
      EXPECT_NEAR(p.position.y(), 0.3, 0.02);
    }
}

TEST(SmoothVessels, AJumpOfTheRadiusBecomesASlopeWithoutOvershoot) {
  std::string text;
  for (int i = 1; i <= 20; ++i)
    text += std::to_string(i) + " 0 " + std::to_string(i) + " 0 0 " + (i <= 10 ? "2" : "1") + " " +
            (i == 1 ? "-1" : std::to_string(i - 1)) + "\n";
  const Path path = smoothVessels(parseSwc(text, "t"), 0.05)[0].path;
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_LE(path[i].radius, path[i - 1].radius + 1e-12);
    EXPECT_LT(path[i - 1].radius - path[i].radius, 0.05);
  }
  EXPECT_NEAR(path.front().radius, 2, 1e-9);
  EXPECT_NEAR(path.back().radius, 1, 1e-9);
}

TEST(TreePhantom, TheBoxFitsTheTreeWhereTheFileHasIt) {
  const TreeFile file(kTrees);
  const Phantom phantom = make(optionsOf(file, 0.5));
  const VolumeGeometry& geometry = phantom.volume.geometry;
  EXPECT_NE(geometry.size[0], geometry.size[1]);
  const formats::CenterlineTree& tree = phantom.truth.tree;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const Vector3d reach = Vector3d::Constant(static_cast<double>(tree.radius[n]) + 4.9);
    EXPECT_TRUE(geometry.containsWorld(toEigen(tree.centre[n]) - reach));
    EXPECT_TRUE(geometry.containsWorld(toEigen(tree.centre[n]) + reach));
  }
  const formats::Status valid = formats::validate(phantom.truth);
  EXPECT_TRUE(valid) << valid.error().text();
}

TEST(TreePhantom, AVoxelIsBrightWhereTheTruthHasALumen) {
  const TreeFile file(kTrees);
  for (const double slice : {0.0, 1.3}) {
    PhantomOptions options = optionsOf(file, 0.5);
    options.sliceThickness = slice;
    const Phantom phantom = make(options);
    const TubeTreeDistance wall(phantom.truth.tree);
    const auto& voxels = std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
    const VolumeGeometry& geometry = phantom.volume.geometry;
    ASSERT_EQ(voxels.size(), geometry.voxelCount());
    std::size_t bright = 0, at = 0;
    for (int z = 0; z < geometry.size[2]; ++z)
      for (int y = 0; y < geometry.size[1]; ++y)
        for (int x = 0; x < geometry.size[0]; ++x, ++at) {
          const double distance =
              wall.nearest(geometry.worldFromIndex({1.0 * x, 1.0 * y, 1.0 * z})).distance;
          // a thick slice takes in shares of the voxels at its ends, which stick out by less than one
          const double depth = geometry.spacing.z() + (slice == 0 ? 0 : 2 * 0.5);
          const double half = 0.5 * std::sqrt(0.5 + depth * depth);
          if (distance < -half) {
            ASSERT_EQ(voxels[at], 1100);
            ++bright;
          } else if (distance > half + 0.01) {
            ASSERT_EQ(voxels[at], 100);
          }
        }
    EXPECT_GT(bright, 100U);
  }
}

TEST(TreePhantom, SeedsAreOneClickForEachLargeVesselAFifthOfTheRadiusOffItsAxis) {
  const TreeFile file(kTrees);
  const Phantom phantom = make(optionsOf(file, 0.3));
  // b000 the trunk, b001 too short, b002 the narrow one, b003 on it (too narrow), b004 the lone one
  ASSERT_EQ(phantom.seeds.size(), 3U);
  EXPECT_EQ(phantom.seeds[0].label, "b000");
  EXPECT_TRUE(phantom.seeds[0].points[0].radius.has_value());
  EXPECT_FALSE(phantom.seeds[0].parent.has_value());
  EXPECT_EQ(phantom.seeds[1].parent, "b000");
  EXPECT_TRUE(phantom.seeds[1].points[0].radius.has_value());  // under half as wide
  EXPECT_FALSE(phantom.seeds[2].parent.has_value());
  for (const SeedBranch& seed : phantom.seeds) {
    ASSERT_EQ(seed.points.size(), 1U);
    for (std::uint32_t b = 0; b < phantom.truth.tree.branches.size(); ++b) {
      if (phantom.truth.tree.branches[b].label != seed.label) continue;
      const WallHit hit = TubeTreeDistance(phantom.truth.tree, b).nearest(seed.points[0].position);
      const double radius = static_cast<double>(phantom.truth.tree.radius[hit.node]);
      EXPECT_NEAR(hit.distance, -0.8 * radius, 0.05 * radius);
    }
  }
}

TEST(TreePhantom, AChildOfAVesselWithoutAClickHangsOnTheNearestOneThatHasOne) {
  // a wide vessel on a short piece of the trunk's side
  const TreeFile file(
      "1 0 0 0 0 2 -1\n2 0 10 0 0 2 1\n3 0 20 0 0 2 2\n4 0 10 4 0 1.2 2\n5 0 10 8 0 0.2 4\n6 0 10 "
      "12 0 0.2 5\n7 0 10 20 0 0.2 6\n8 0 14 12 0 0.19 6\n9 0 20 12 0 1.5 8\n10 0 30 12 0 1.5 "
      "9\n11 "
      "0 40 12 0 1.5 10\n12 0 50 12 0 1.5 11\n");
  const Phantom phantom = make(optionsOf(file, 0.4));
  ASSERT_EQ(phantom.truth.tree.branches.size(), 3U);
  ASSERT_EQ(phantom.seeds.size(), 2U);
  EXPECT_EQ(phantom.seeds[1].label, "b002");
  EXPECT_EQ(phantom.seeds[1].parent, "b000");
}

TEST(TreePhantom, FadeLosesTheShareAtTheFarthestEnd) {
  const TreeFile file("1 0 0 0 0 2 -1\n2 0 20 0 0 2 1\n");
  PhantomOptions options = optionsOf(file, 0.5);
  options.fade = 0.6;
  const Phantom phantom = make(options);
  const auto& voxels = std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
  const VolumeGeometry& g = phantom.volume.geometry;
  const auto valueAt = [&](double x) {
    const Vector3d i = g.indexFromWorld({x, 0, 0});
    return voxels[(static_cast<std::size_t>(std::lround(i.z())) *
                       static_cast<std::size_t>(g.size[1]) +
                   static_cast<std::size_t>(std::lround(i.y()))) *
                      static_cast<std::size_t>(g.size[0]) +
                  static_cast<std::size_t>(std::lround(i.x()))];
  };
  EXPECT_NEAR(valueAt(0), 1100, 12);
  EXPECT_NEAR(valueAt(10), 800, 12);
  EXPECT_NEAR(valueAt(20), 500, 12);
}

TEST(TreePhantom, AVoxelThatIsTooSmallIsRefusedWithOneThatIsNot) {
  const TreeFile file("1 0 0 0 0 2 -1\n2 0 90 80 70 2 1\n");
  const std::string message = refusal(optionsOf(file, 0.02));
  const auto at = message.rfind("voxel ");
  ASSERT_NE(at, std::string::npos) << message;
  const double workable = std::stod(message.substr(at + 6));
  EXPECT_GT(workable, 0.05);
  // 94 x 84 x 74 mm and a margin of ten voxels
  const auto voxels = [](double mm, double v) { return std::ceil(mm / v) + 21; };
  EXPECT_LE(voxels(94, workable) * voxels(84, workable) * voxels(74, workable), 536870912.0);
  EXPECT_NE(refusal(optionsOf(TreeFile("1 0 0 0 0 2 -1\n2 0 1e8 1e8 1e8 2 1\n"), 0.3))
                .find("taken as mm"),
            std::string::npos);
}

TEST(TreePhantom, ATreeThatWouldTakeHoursIsRefused) {
  std::string text = "0 0 0 0 0 40 -1\n";
  for (int i = 1; i < 20000; ++i)
    text += std::to_string(i) + " 0 " + std::to_string(50 * (i % 2)) + " 0 0 40 " +
            std::to_string(i - 1) + "\n";
  const TreeFile file(text);
  EXPECT_NE(refusal(optionsOf(file, 0.3)).find("too much to draw"), std::string::npos);
}

TEST(TreePhantom, HostileShapesGiveAValidTruth) {
  for (const char* text : {"1 0 0 0 0 1 -1\n", "1 0 0 0 0 1 -1\n2 0 3 0 0 1 1\n3 0 0 0 0 1 2\n",
                           "1 0 0 0 0 1 -1\n2 0 0 0 0 1 1\n3 0 0 0 0 1 2\n",
                           "1 0 0 0 0 1 -1\n2 0 1e-12 0 0 1 1\n3 0 5 0 0 1 2\n"}) {
    const TreeFile file(text);
    const Phantom phantom = make(optionsOf(file, 0.5));
    const formats::Status valid = formats::validate(phantom.truth);
    EXPECT_TRUE(valid) << text << valid.error().text();
  }
}

}  // namespace
}  // namespace lumen::convert
