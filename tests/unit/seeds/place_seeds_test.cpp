// SPDX-License-Identifier: Apache-2.0
// Seeds in a volume.
#include "converters/io/seeds/place_seeds.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Voxel centres from (100, 0, 0) to (105, 10, 15) mm.
VolumeGeometry volume() {
  VolumeGeometry geometry;
  geometry.size = {11, 21, 31};
  geometry.spacing = {0.5, 0.5, 0.5};
  geometry.origin = {100, 0, 0};
  return geometry;
}

/// Patient coordinates around zero, 40 mm wide, and off-centre: no flip of it is within it.
VolumeGeometry head() {
  VolumeGeometry geometry;
  geometry.size = {81, 81, 81};
  geometry.spacing = {0.5, 0.5, 0.5};
  geometry.origin = {10, -60, 100};
  return geometry;
}

/// "v0", "v1".
std::string numbered(int i) {
  std::string label = std::to_string(i);
  label.insert(0, 1, 'v');
  return label;
}

SeedBranch vessel(const std::string& label, const Vector3d& point,
                  std::optional<double> radius = {}) {
  SeedBranch branch;
  branch.label = label;
  branch.points.push_back({point, radius});
  return branch;
}

PlacedSeeds place(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry) {
  return placeSeeds(seeds, geometry, "s.json");
}

std::string placeRefusal(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry) {
  return refusal([&] { (void)place(seeds, geometry); });
}

/// `count` vessels within `head()`, positions changed by `change`.
std::vector<SeedBranch> seedsOfHead(int count,
                                    const std::function<Vector3d(const Vector3d&)>& change) {
  std::vector<SeedBranch> seeds;
  for (int i = 0; i < count; ++i)
    seeds.push_back(vessel(numbered(i), change({20.0 + i % 20, -50.0 + i % 20, 110.0 + i % 20})));
  return seeds;
}

TEST(PlaceSeeds, InsideIsUpToHalfAVoxelBeyondTheOutermostCentres) {
  for (const Vector3d& inside : {Vector3d(100, 0, 0), Vector3d(105, 10, 15)})
    EXPECT_EQ(place({vessel("a", inside)}, volume()).seeds[0].points[0].position, inside);
  const PlacedSeeds moved = place({vessel("a", {105.24, 10, -0.2})}, volume());
  EXPECT_TRUE(moved.leftPoints.empty());
  const Vector3d at = moved.seeds[0].points[0].position;
  EXPECT_TRUE(volume().containsWorld(at));
  EXPECT_LT((at - Vector3d(105, 10, 0)).norm(), 1e-5);
  expectRefused(placeRefusal({vessel("a", {105.3, 10, 15})}, volume()),
                {"3: ", "s.json", "\"a\"", "point 1", "(105.3, 10, 15)", "0.3 mm outside",
                 "(100, 0, 0) to (105, 10, 15)", "11 x 21 x 31"});
}

TEST(PlaceSeeds, ClicksInTheCoordinatesOfAVolumeThatWasMovedNearZeroArePlaced) {
  const Vector3d inside(103, 5, 6), move(10'000'000, -20'000, 0);
  EXPECT_EQ(place({vessel("a", inside + move)}, volume()).seeds[0].points[0].position, inside);
  expectRefused(placeRefusal({vessel("a", {20'000, -8000, 26'000})}, volume()),
                {"(20000, -8000, 26000)"});
}

TEST(PlaceSeeds, DistancesInMessagesHaveSixSignificantDigits) {
  expectRefused(placeRefusal({vessel("a", {105.623456789, 10, 15})}, volume()),
                {"lies 0.623457 mm outside", "(105.623, 10, 15)"});
}

TEST(PlaceSeeds, OneBadSeedOfFortyIsLeftOutAndNamed) {
  std::vector<SeedBranch> seeds = seedsOfHead(39, [](const Vector3d& p) { return p; });
  seeds.insert(seeds.begin() + 7, vessel("astray", {500, 0, 0}));
  const PlacedSeeds placed = place(seeds, head());
  EXPECT_EQ(placed.seeds.size(), 39U);
  ASSERT_EQ(placed.leftOut.size(), 1U);
  EXPECT_EQ(placed.leftOut[0].label, "astray");
  EXPECT_NE(placed.leftOut[0].reason.find("outside of the volume"), std::string::npos);
  EXPECT_TRUE(placed.advice.empty()) << placed.advice;
}

TEST(PlaceSeeds, ChildrenOfABranchThatIsLeftOutGoWithIt) {
  std::vector<SeedBranch> seeds{vessel("root", {500, 0, 0}), vessel("child", {20, -50, 110}),
                                vessel("other", {20, -50, 120})};
  seeds[1].parent = "root";
  const PlacedSeeds placed = place(seeds, head());
  ASSERT_EQ(placed.seeds.size(), 1U);
  ASSERT_EQ(placed.leftOut.size(), 2U);
  EXPECT_EQ(placed.leftOut[1].label, "child");
  EXPECT_NE(placed.leftOut[1].reason.find("\"root\""), std::string::npos);
}

TEST(PlaceSeeds, ABranchIsUsedWithoutItsPointsThatLieOutside) {
  SeedBranch curve = vessel("curve", {20, -50, 110});
  curve.points.push_back({{500, 0, 0}, {}});
  curve.points.push_back({{20, -50, 114}, {}});
  const PlacedSeeds placed = place({curve}, head());
  EXPECT_EQ(placed.seeds[0].points.size(), 2U);
  ASSERT_EQ(placed.leftPoints.size(), 1U);
  EXPECT_NE(placed.leftPoints[0].reason.find("point 2"), std::string::npos);
}

struct Misread {
  std::string name;
  std::function<Vector3d(const Vector3d&)> asInFile;
  std::vector<std::string> advice;
};

TEST(PlaceSeeds, SaysHowAllPointsWouldLieInside) {
  const std::vector<Misread> all = {
      {"RAS",
       [](const Vector3d& p) { return Vector3d(-p.x(), -p.y(), p.z()); },
       {"x and y flipped", "seeds-frame ras"}},
      {"voxels",
       [](const Vector3d& p) { return head().indexFromWorld(p); },
       {"as voxel indices", "seeds-frame voxel"}},
      {"metres",
       [](const Vector3d& p) { return Vector3d(p / 1000); },
       {"as metres", "seeds-unit m"}},
      {"metres in RAS",
       [](const Vector3d& p) { return Vector3d(-p.x() / 1000, -p.y() / 1000, p.z() / 1000); },
       {"metres in RAS", "seeds-frame ras seeds-unit m"}}};
  for (const Misread& misread : all) {
    std::vector<std::string> words = misread.advice;
    words.insert(words.begin(), {"3: ", "none of its 5 seeds", "all 5 points"});
    expectRefused(placeRefusal(seedsOfHead(5, misread.asInFile), head()), words);
  }
}

TEST(PlaceSeeds, OneOfManyOutsideIsNoReasonToReadAllInAnotherWay) {
  // flipped, all would lie inside: but so do most as they are
  VolumeGeometry centred = head();
  centred.origin = {-20, -20, 100};
  std::vector<SeedBranch> seeds;
  for (int i = 0; i < 10; ++i) seeds.push_back(vessel(numbered(i), {i * 1.0, 2, 110}));
  seeds.push_back(vessel("astray", {-20.4, 21, 110}));
  centred.size[1] = 80;
  const PlacedSeeds placed = place(seeds, centred);
  EXPECT_EQ(placed.leftOut.size(), 1U);
  EXPECT_EQ(placed.advice, "");
}

TEST(PlaceSeeds, AdviceIsDecidedByAllSeedsNotByOne) {
  // one seed would lie inside if flipped, forty as voxels
  std::vector<SeedBranch> seeds =
      seedsOfHead(40, [](const Vector3d& p) { return head().indexFromWorld(p); });
  seeds.insert(seeds.begin(), vessel("flipped", {-20, 50, 110}));
  const std::string refused = placeRefusal(seeds, head());
  expectRefused(refused, {"40 of the 41 points", "seeds-frame voxel"});
  EXPECT_EQ(refused.find("seeds-frame ras"), std::string::npos);
}

TEST(PlaceSeeds, SaysThatAVolumeMayBeInMetres) {
  VolumeGeometry metres = head();
  metres.spacing *= 1e-3;
  metres.origin *= 1e-3;
  expectRefused(placeRefusal(seedsOfHead(5, [](const Vector3d& p) { return p; }), metres),
                {"only 0.0405 mm", "header read as metres", "add unit m"});
}

TEST(PlaceSeeds, MetresAtTheOriginOfAVolumeAreSuspicious) {
  VolumeGeometry corner = head();
  corner.origin = {0, 0, 0};
  const std::vector<SeedBranch> seeds{vessel("a", {0.02, 0.01, 0.005}),
                                      vessel("b", {0.03, 0.02, 0.03})};
  EXPECT_NE(place(seeds, corner).advice.find("seeds-unit m"), std::string::npos);
  EXPECT_EQ(place({vessel("a", {20, 10, 5})}, corner).advice, "");
}

TEST(PlaceSeeds, APointAtZeroIsNoReasonToThinkOfMetres) {
  VolumeGeometry corner = head();
  corner.origin = {0, 0, 0};
  EXPECT_EQ(place({vessel("a", {0, 0, 0})}, corner).advice, "");
}

TEST(PlaceSeeds, OtherReadingsAreInPatientSpace) {
  const auto readings = otherReadings({vessel("a", {2, -3, 4})}, head());
  const auto ras = std::find_if(readings.begin(), readings.end(), [](const RereadSeeds& other) {
    return other.options == "seeds-frame ras";
  });
  ASSERT_NE(ras, readings.end());
  EXPECT_EQ(ras->seeds[0].points[0].position, Vector3d(-2, 3, 4));
}

TEST(PlaceSeeds, RadiusNoVesselHasIsRefusedWithTheUnitThatWouldMakeSense) {
  expectRefused(placeRefusal({vessel("a", {20, -50, 110}, 1300)}, head()),
                {"3: ", "\"a\"", "radius of 1300 mm", "0.05 to 20.25 mm", "micrometres", "1.3 mm"});
  expectRefused(placeRefusal({vessel("a", {20, -50, 110}, 1.3e-3)}, head()),
                {"radius of 0.0013 mm", "metres", "1.3 mm"});
  for (const double radius : {0.06, 1.3, 20.0})
    EXPECT_EQ(place({vessel("a", {20, -50, 110}, radius)}, head()).seeds.size(), 1U) << radius;
}

TEST(PlaceSeeds, OneBadRadiusOfManyIsLeftOut) {
  std::vector<SeedBranch> seeds = seedsOfHead(5, [](const Vector3d& p) { return p; });
  seeds[2].points[0].radius = 1300;
  const PlacedSeeds placed = place(seeds, head());
  EXPECT_EQ(placed.seeds.size(), 4U);
  ASSERT_EQ(placed.leftOut.size(), 1U);
  EXPECT_NE(placed.leftOut[0].reason.find("1300 mm"), std::string::npos);
}

TEST(PlaceSeeds, VoxelsBecomePatientCoordinates) {
  SeedBranch branch = vessel("a", {4, 6, 8}, 2.0);
  branch.direction = Vector3d(0, 0.6, 0.8);
  branch.frame.system = SeedSystem::Voxel;
  VolumeGeometry geometry = volume();
  geometry.spacing = {0.5, 0.5, 1};
  const PlacedSeeds placed = place({branch}, geometry);
  EXPECT_EQ(placed.seeds[0].points[0].position, Vector3d(102, 3, 8));
  EXPECT_EQ(placed.seeds[0].points[0].radius, 2.0);
  EXPECT_LT((*placed.seeds[0].direction - Vector3d(0, 0.3, 0.8).normalized()).norm(), 1e-12);
  EXPECT_EQ(placed.seeds[0].frame.system, SeedSystem::Lps);
}

TEST(PlaceSeeds, AHundredThousandPointsAreJudgedOneByOne) {
  SeedBranch curve = vessel("curve", {20, -50, 110});
  for (int i = 0; i < 100000; ++i) curve.points.push_back({{500.0 + i, 0, 0}, {}});
  const PlacedSeeds placed = place({curve}, head());
  EXPECT_EQ(placed.seeds[0].points.size(), 1U);
  EXPECT_EQ(placed.leftPoints.size(), 100000U);
}

TEST(PlaceSeeds, TextsOfTheFileAreEscaped) {
  const std::string refused = placeRefusal({vessel("a\n\x1b[31mvalid", {500, 0, 0})}, head());
  EXPECT_EQ(refused.find('\n'), std::string::npos);
  EXPECT_EQ(refused.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace lumen::convert
