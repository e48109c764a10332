// SPDX-License-Identifier: Apache-2.0
// Whole trees from volumes without a click, against the truth of phantoms.
#include <algorithm>
#include <span>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/judge/compare/compare.h"
#include "converters/stages/editing/correct_topology.h"
#include "converters/stages/editing/further_inlets.h"
#include "converters/stages/finding/find_vessels.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Phantom phantom(const std::string& name, const std::string& clutter = "",
                std::uint64_t seed = PhantomOptions{}.seed) {
  PhantomOptions options;
  options.seed = seed;
  options.name = name;
  options.clutter = clutter;
  Progress silent;
  return makePhantom(options, silent);
}

formats::Case treeOf(const Volume& volume, Progress& progress) {
  return trackAlongCourses(volume, findVessels(volume, false, {}, progress).courses, {}, {},
                           progress)
      .result;
}

struct Expected {
  std::string phantom;
  std::size_t mostBranches;
};

class WholeTree : public ::testing::TestWithParam<Expected> {};

TEST_P(WholeTree, CoversTheTruthWithoutAClick) {
  Progress silent;
  const Phantom made = phantom(GetParam().phantom);
  const formats::Case found = treeOf(made.volume, silent);
  const Comparison comparison = compareCases(found, made.truth, silent);
  EXPECT_GE(comparison.score.overlap, 0.98);
  EXPECT_LE(comparison.score.falseLength, 0.5);
  EXPECT_LE(found.tree.branches.size(), GetParam().mostBranches);
}

INSTANTIATE_TEST_SUITE_P(Phantoms, WholeTree,
                         ::testing::Values(Expected{"tube", 1}, Expected{"bifurcation", 2},
                                           Expected{"hairpin", 1}, Expected{"dropout", 1},
                                           Expected{"aneurysm", 2}, Expected{"kissing", 3},
                                           Expected{"companion", 3}, Expected{"thick-slices", 2}),
                         [](const auto& each) {
                           std::string name = each.param.phantom;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(WholeTreeAtFaces, ReachesThemWithin0p6Radii) {
  const double radius = 4.5;
  const Volume volume = drawVolume(64, 0.5, [&](const Vector3d& p) {
    return capsule(p, {15, 17, -20}, {15, 17, 50}, radius);
  });
  Progress silent;
  const formats::CenterlineTree tree = treeOf(volume, silent).tree;
  ASSERT_EQ(tree.branches.size(), 1U);
  const auto [first, last] = std::minmax(tree.centre.front().z, tree.centre.back().z);
  EXPECT_LT(double{first}, 0.6 * radius);
  EXPECT_GT(double{last}, 31.5 - 0.6 * radius);
  for (const formats::Vec3f& direction : tree.direction) EXPECT_GT(std::abs(direction.z), 0.99F);
}

// Without a look at the edges, 161 mm of bone came out of the first and 62 mm of the second.
TEST(WholeTreeInBone, HasHardlyAnyOfIt) {
  Progress silent;
  for (const std::string name : {"bifurcation", "kissing"}) {
    const Phantom made = phantom(name, "bone");
    const FoundVessels found = findVessels(made.volume, false, {}, silent);
    const formats::Case tree =
        trackAlongCourses(made.volume, found.courses,
                          {[&](const Vector3d& p) { return found.isBone(p); }}, {}, silent)
            .result;
    const Comparison comparison = compareCases(tree, made.truth, silent);
    EXPECT_LT(comparison.score.falseLength, 20) << name;
    EXPECT_LT(comparison.score.missed, 5) << name;
  }
}

/// A vessel of radius 1.6 along z, and one of radius 1 that comes from the side, runs along it with
/// walls that touch for 7 mm, and goes off again.
double kiss(const Vector3d& p) {
  return std::min(
      {capsule(p, {7, 8, 0.6}, {7, 8, 18.6}, 1.6), capsule(p, {15, 8, 0.6}, {9.6, 8, 6}, 1),
       capsule(p, {9.6, 8, 6}, {9.6, 8, 13}, 1), capsule(p, {9.6, 8, 13}, {15, 8, 18.4}, 1)});
}

/// Places a millimetre apart, where that vessel touches, that are on no axis of a tree.
int missedWhereTheyTouch(const formats::CenterlineTree& tree) {
  int count = 0;
  for (int z = 6; z <= 13; ++z) {
    const Vector3d place(9.6, 8, z);
    count += std::none_of(tree.centre.begin(), tree.centre.end(), [&](const formats::Vec3f& c) {
      return (toEigen(c) - place).norm() < 0.6;
    });
  }
  return count;
}

TEST(TrackCourses, TheLumenThatKnownVesselsLeaveIsTrackedToo) {
  const Volume volume = drawVolume(96, 0.2, kiss);
  Progress silent;
  const FoundVessels found = findVessels(volume, false, {}, silent);
  SeedBranch host;
  host.label = "host";
  for (int i = 0; i <= 60; ++i) host.points.push_back({{7, 8, 0.8 + i * 0.29}, 1.6});
  const auto tracked = [&](const CoursesInRemainingLumen& remaining) {
    return trackAlongCourses(volume, {host}, {}, {}, silent, remaining).result.tree;
  };
  EXPECT_EQ(missedWhereTheyTouch(tracked({})), 8);
  const formats::CenterlineTree both = tracked([&](std::span<const WorldBall> vessels) {
    return coursesInRemainingLumen(found, vessels, silent);
  });
  EXPECT_EQ(missedWhereTheyTouch(both), 0);
  EXPECT_EQ(both.branches.size(), 2U);
  EXPECT_EQ(both.branches[0].label, "host");
}

/// A tree with its vessels beside vessels, its crossings and its inlets.
formats::Case wholeTreeOf(const Volume& volume, Progress& progress) {
  const FoundVessels found = findVessels(volume, false, {}, progress);
  formats::Case tree = trackAlongCourses(volume, found.courses, {}, {}, progress,
                                         [&](std::span<const WorldBall> vessels) {
                                           return coursesInRemainingLumen(found, vessels, progress);
                                         })
                           .result;
  const LumenInVolume around{[&](const Vector3d& p) { return found.isLumen(p); },
                             [&](const Vector3d& p) { return volume.geometry.containsWorld(p); }};
  correctTopology(tree, around);
  beginAtFurtherInlets(tree, around.isInside);
  return tree;
}

/// The first patient has a vessel that touches a wider one for 9 mm, along which its course leads.
TEST(WholePatient, HasTheVesselThatAnotherHidesAsOne) {
  Progress silent;
  const Phantom made = phantom("patient");
  const formats::Case tree = wholeTreeOf(made.volume, silent);
  const CenterlineScore score = compareCases(tree, made.truth, silent).score;
  EXPECT_LT(score.missed, 1);
  EXPECT_LT(score.falseLength, 3);
  EXPECT_EQ(tree.tree.branches.size(), made.truth.tree.branches.size());
}

/// The third patient has a vessel that touches another, from which a skeleton gets into its middle.
TEST(WholePatient, HasAVesselThatIsEnteredWhereItTouchesAsOne) {
  Progress silent;
  const Phantom made = phantom("patient", "", 3);
  const formats::Case tree = wholeTreeOf(made.volume, silent);
  EXPECT_EQ(tree.tree.branches.size(), made.truth.tree.branches.size());
  EXPECT_TRUE(tree.tree.links.empty());
}

TEST(WholeCircleOfWillis, HasThreeInletsAndThreeCommunicatingArteries) {
  Progress silent;
  const formats::CenterlineTree tree = wholeTreeOf(phantom("willis").volume, silent).tree;
  EXPECT_EQ(std::count(tree.parent.begin(), tree.parent.end(), formats::kNoParent), 3);
  EXPECT_EQ(tree.links.size(), 3U);
}

TEST(TrackCourses, ACandidateWithoutAWallIsNoVesselAndItsChildrenHangOnTheOneBefore) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min(capsule(p, {4, 6, 0.6}, {4, 6, 12}, 0.8),
                    capsule(p, {4, 6, 6}, {11, 6, 9}, 0.5));
  });
  const auto course = [](const std::string& label, const Vector3d& a, const Vector3d& b,
                         std::optional<std::string> parent) {
    SeedBranch seed;
    seed.label = label;
    seed.parent = std::move(parent);
    for (int i = 0; i <= 20; ++i) seed.points.push_back({a + i / 20.0 * (b - a), 0.5});
    return seed;
  };
  Progress silent;
  const TrackResult out = trackAlongCourses(volume,
                                            {course("trunk", {4, 6, 0.8}, {4, 6, 11.8}, {}),
                                             course("nothing", {4, 6, 6}, {4, 12, 6}, "trunk"),
                                             course("child", {4, 6, 6}, {10.8, 6, 8.9}, "nothing")},
                                            {}, {}, silent);
  ASSERT_EQ(out.failures.size(), 1U);
  EXPECT_EQ(out.failures[0].label, "nothing");
  const auto& tree = out.result.tree;
  ASSERT_EQ(tree.branches.size(), 2U);
  EXPECT_EQ(tree.branches[1].label, "child");
  const int above = tree.parent[tree.branches[1].firstNode];
  ASSERT_GE(above, 0);
  EXPECT_EQ(tree.branch[static_cast<std::size_t>(above)], 0U);
}

TEST(TrackCourses, ACandidateOnTheWallOfItsParentIsABump) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return capsule(p, {6, 6, 0.6}, {6, 6, 12}, 1.5);
  });
  SeedBranch trunk, bump;
  trunk.label = "trunk";
  bump.label = "bump";
  bump.parent = "trunk";
  for (int i = 0; i <= 40; ++i) trunk.points.push_back({{6, 6, 0.8 + i * 0.275}, 1.5});
  for (int i = 0; i <= 10; ++i) bump.points.push_back({{6 + i * 0.16, 6, 6 + i * 0.1}, 1.0});
  Progress silent;
  const TrackResult out = trackAlongCourses(volume, {trunk, bump}, {}, {}, silent);
  EXPECT_EQ(out.result.tree.branches.size(), 1U);
}

TEST(TrackCourses, ThePlaceOfAVolumeInSpaceDecidesNothing) {
  Phantom made = phantom("companion");
  Progress silent;
  const VolumeGeometry before = made.volume.geometry;
  const formats::CenterlineTree here = treeOf(made.volume, silent).tree;
  VolumeGeometry& geometry = made.volume.geometry;
  geometry.origin += Vector3d(-123.456789, 1e-6, 77.7);
  geometry.direction = Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  geometry.spacing *= 1 + 1e-8;  // as a header in floats has it
  const formats::CenterlineTree there = treeOf(made.volume, silent).tree;
  ASSERT_EQ(there.nodeCount(), here.nodeCount());
  EXPECT_EQ(there.parent, here.parent);
  for (std::size_t n = 0; n < here.nodeCount(); ++n) {
    const Vector3d index = before.indexFromWorld(toEigen(here.centre[n]));
    EXPECT_LT((geometry.worldFromIndex(index) - toEigen(there.centre[n])).norm(), 1e-4) << n;
    EXPECT_NEAR(there.radius[n], here.radius[n], 1e-5);
  }
}

/// With cylinders drawn at random, four seeds made this tree 41.6 to 42.9 mm long.
TEST(TrackCourses, AnotherRandomSeedMovesNoEnd) {
  Progress silent;
  const Phantom made = phantom("thick-slices");
  const std::vector<SeedBranch> courses = findVessels(made.volume, false, {}, silent).courses;
  const auto tracked = [&](std::uint64_t seed) {
    TrackOptions options;
    options.seed = seed;
    return trackAlongCourses(made.volume, courses, {}, options, silent).result.tree;
  };
  const formats::CenterlineTree first = tracked(1);
  for (std::uint64_t seed = 2; seed <= 4; ++seed) {
    const formats::CenterlineTree other = tracked(seed);
    ASSERT_EQ(other.branches.size(), first.branches.size()) << seed;
    for (std::size_t b = 0; b < first.branches.size(); ++b) {
      const formats::Branch &own = other.branches[b], &its = first.branches[b];
      ASSERT_EQ(own.nodeCount, its.nodeCount) << seed;
      for (const std::uint32_t n : {0U, its.nodeCount - 1})
        EXPECT_LT(
            (toEigen(other.centre[own.firstNode + n]) - toEigen(first.centre[its.firstNode + n]))
                .norm(),
            0.02)
            << seed;
    }
  }
}

TEST(TrackCourses, NoNodeIsPutWhereNoVesselIs) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return capsule(p, {6, 6, 0.6}, {6, 6, 12}, 1.5);
  });
  SeedBranch course;
  course.label = "course";
  for (int i = 0; i <= 40; ++i) course.points.push_back({{6, 6, 0.8 + i * 0.275}, 1.5});
  Progress silent;
  const auto trackedReach = [&](const PlaceTest& isNoVessel) {
    double reach = 0;
    const auto out = trackAlongCourses(volume, {course}, isNoVessel, {}, silent).result;
    for (const formats::Vec3f& centre : out.tree.centre)
      reach = std::max(reach, static_cast<double>(centre.z));
    return reach;
  };
  EXPECT_GT(trackedReach({}), 11);
  const double stopped = trackedReach({[](const Vector3d& p) { return p.z() > 7; }});
  EXPECT_GT(stopped, 5);
  EXPECT_LE(stopped, 7);
}

TEST(TrackCourses, BoneThatIsKnownByItsLevelCutsNoVesselBesideIt) {
  Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return capsule(p, {6, 6, -9}, {6, 6, 22}, 1.5);
  });
  auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  const auto isBone = [](const Vector3d& p) { return p.x() > 7.2 && p.z() > 3 && p.z() < 9.5; };
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (isBone(volume.geometry.position(volume.geometry.cell(i)))) voxels[i] = 2500;
  SeedBranch course;
  course.label = "course";
  for (int i = 0; i <= 40; ++i) course.points.push_back({{6, 6, 0.8 + i * 0.275}, 1.5});
  Progress silent;
  const auto branches = [&](bool isByLevel) {
    return trackAlongCourses(volume, {course}, {isBone, isByLevel}, {}, silent)
        .result.tree.branches.size();
  };
  EXPECT_EQ(branches(true), 1U);
  EXPECT_NE(branches(false), 1U) << "edges beside bone are judged where nothing else shows it";
}

TEST(TrackCoursesIntoCase, AddsWhatNoSeedHasTrackedAndKeepsTheRest) {
  Progress silent;
  const Phantom made = phantom("bifurcation");
  const TrackResult clicked = trackFromSeeds(made.volume, {made.seeds[0]}, {}, silent);
  const TrackingVolume tracking(made.volume, clicked.result, silent);
  const AddedTracks added = addTracksAlongCourses(
      tracking, clicked.result, findVessels(made.volume, false, {}, silent).courses, {}, silent);
  const auto &before = clicked.result.tree, &after = added.result.tree;
  ASSERT_GT(after.branches.size(), before.branches.size());
  EXPECT_EQ(after.branches[0].label, made.seeds[0].label);
  EXPECT_TRUE(std::equal(before.centre.begin(), before.centre.end(), after.centre.begin()));
  EXPECT_GE(compareCases(added.result, made.truth, silent).score.overlap, 0.98);
  for (std::size_t b = 1; b < after.branches.size(); ++b)
    EXPECT_GE(after.parent[after.branches[b].firstNode], 0) << after.branches[b].label;
}

TEST(TrackCoursesIntoCase, AddsNothingToAWholeTree) {
  Progress silent;
  const Phantom made = phantom("bifurcation");
  const TrackResult clicked = trackFromSeeds(made.volume, made.seeds, {}, silent);
  const TrackingVolume tracking(made.volume, clicked.result, silent);
  const AddedTracks added = addTracksAlongCourses(
      tracking, clicked.result, findVessels(made.volume, false, {}, silent).courses, {}, silent);
  EXPECT_EQ(added.result, clicked.result);
}

}  // namespace
}  // namespace lumen::convert
