// SPDX-License-Identifier: Apache-2.0
// New clicks in a case that is tracked, on drawn tubes.
#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/vectors.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/track_case.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::kNoParent;

AddedTracks further(const Volume& volume, const Case& known, const std::vector<SeedBranch>& seeds) {
  Progress silent;
  return addTracksFromSeeds(TrackingVolume(volume, known, silent), known, seeds, silent);
}

/// The T with its trunk tracked.
struct Tee {
  Volume volume = tee(0.6);
  Case known = trackOne(volume, {seedAt("trunk", {6.4, 6.4, 3})}).result;
};

SeedBranch childSeed() {
  return seedAt("child", {10, 6.4, 6.4});
}

/// Everything that was there is there under its index.
void expectKept(const Case& before, const Case& after) {
  const std::size_t n = before.tree.nodeCount();
  ASSERT_GE(after.tree.nodeCount(), n);
  const auto isSame = [n](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n), b.begin());
  };
  EXPECT_TRUE(isSame(before.tree.centre, after.tree.centre));
  EXPECT_TRUE(isSame(before.tree.direction, after.tree.direction));
  EXPECT_TRUE(isSame(before.tree.radius, after.tree.radius));
  EXPECT_TRUE(isSame(before.tree.parent, after.tree.parent));
  EXPECT_TRUE(isSame(before.points->offset, after.points->offset));
  EXPECT_TRUE(std::equal(before.points->position.begin(), before.points->position.end(),
                         after.points->position.begin()));
  EXPECT_TRUE(std::equal(before.tree.branches.begin(), before.tree.branches.end(),
                         after.tree.branches.begin()));
  const auto valid = formats::validate(after);
  EXPECT_TRUE(valid) << valid.error().text();
}

void expectChildOfTrunk(const AddedTracks& out) {
  ASSERT_EQ(out.result.tree.branches.size(), 2U);
  const auto& child = out.result.tree.branches[1];
  EXPECT_EQ(child.label, "child");
  EXPECT_EQ(out.firstNewNode, child.firstNode);
  ASSERT_NE(child.parentNode, kNoParent);
  // beside the middle of the trunk, and out to the end of the child
  EXPECT_NEAR(out.result.tree.centre[static_cast<std::size_t>(child.parentNode)].z, 6.4, 0.6);
  EXPECT_GT(out.result.tree.centre.back().x, 11.4F);
  EXPECT_NEAR(out.result.tree.radius.back(), 0.6, 0.1);
}

TEST(TrackFurther, AddsAChildThatNamesItsParent) {
  const Tee t;
  SeedBranch seed = childSeed();
  seed.parent = "trunk";
  const AddedTracks out = further(t.volume, t.known, {seed});
  expectKept(t.known, out.result);
  expectChildOfTrunk(out);
  EXPECT_TRUE(out.changed.empty());
}

TEST(TrackFurther, JoinsAVesselToWhatItRunsIntoIfItNamesNoParent) {
  const Tee t;
  const AddedTracks out = further(t.volume, t.known, {childSeed()});
  expectKept(t.known, out.result);
  expectChildOfTrunk(out);
}

TEST(TrackFurther, LeavesAVesselAloneThatTheLumenDoesNotJoin) {
  const auto volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min(capsule(p, {4, 6.4, 0.4}, {4, 6.4, 12.2}, 0.8),
                    capsule(p, {8.5, 6.4, 0.4}, {8.5, 6.4, 12.2}, 0.6));
  });
  const Case known = trackOne(volume, {seedAt("one", {4, 6.4, 5})}).result;
  const AddedTracks out = further(volume, known, {seedAt("other", {8.5, 6.4, 6})});
  ASSERT_EQ(out.result.tree.branches.size(), 2U);
  EXPECT_EQ(out.result.tree.branches[1].parentNode, kNoParent);
  expectKept(known, out.result);
}

TEST(TrackFurther, StartsNothingInAVesselThatIsThere) {
  const Tee t;
  const AddedTracks out = further(t.volume, t.known, {seedAt("again", {6.4, 6.4, 9})});
  ASSERT_EQ(out.failures.size(), 1U);
  EXPECT_EQ(out.failures[0].reason, kTrackedAlready);
  EXPECT_EQ(out.result, t.known);
}

TEST(TrackFurther, TracksSeveralSeedsWhateverTheirOrder) {
  const Tee t;
  const Case nothing = trackOne(t.volume, {childSeed()}).result;
  Case known = nothing;
  known.tree.branches[0].label = "first";
  SeedBranch low = seedAt("low", {6.4, 6.4, 3}), high = seedAt("high", {6.4, 6.4, 9});
  high.parent = "low";
  const AddedTracks out = further(t.volume, known, {high, low});
  expectKept(known, out.result);
  EXPECT_GE(out.result.tree.branches.size(), 2U);
}

TEST(TrackFurther, RecordsWhatWasTracked) {
  const Tee t;
  const AddedTracks out = further(t.volume, t.known, {childSeed()});
  const auto& step = out.result.metadata.steps.back();
  EXPECT_EQ(step.name, "edit");
  EXPECT_EQ(std::get<std::string>(step.parameters.at("0001")),
            "tracked \"child\" from (10, 6.4, 6.4) mm");
}

TEST(TrackFurther, GivesNewNodesNoModelsAndDropsArraysThatItCannotContinue) {
  Tee t;
  const std::size_t n = t.known.tree.nodeCount();
  t.known.models = formats::BlobbyModels{};
  t.known.models->offset.assign(n + 1, 0);
  t.known.metadata.extensionsUsed.push_back("ACME_flow");
  t.known.nodeArrays.push_back({"ACME_flow.speed", 1, "", std::vector<float>(n, 1)});
  const AddedTracks out = further(t.volume, t.known, {childSeed()});
  EXPECT_EQ(out.result.models->offset.size(), out.result.tree.nodeCount() + 1);
  EXPECT_EQ(out.droppedArrays, std::vector<std::string>{"ACME_flow.speed"});
  expectKept(t.known, out.result);
}

TEST(TrackFurther, KeepsSystemsAndGivesNewVesselsNone) {
  Tee t;
  const std::size_t n = t.known.tree.nodeCount();
  formats::setNodeSystems(t.known,
                          std::vector<formats::VesselSystem>(n, formats::VesselSystem::Vein));
  const AddedTracks out = further(t.volume, t.known, {childSeed()});
  EXPECT_TRUE(out.droppedArrays.empty());
  expectChildOfTrunk(out);
  EXPECT_EQ(formats::readBranchSystems(out.result),
            (std::vector{formats::VesselSystem::Vein, formats::VesselSystem::Unknown}));
  expectKept(t.known, out.result);
}

TEST(TrackFurther, RefusesNamesThatAreTakenAndParentsThatAreNone) {
  const Tee t;
  EXPECT_THROW(further(t.volume, t.known, {seedAt("trunk", {10, 6.4, 6.4})}), Error);
  EXPECT_THROW(further(t.volume, t.known, {childSeed(), childSeed()}), Error);
  SeedBranch orphan = childSeed(), circle = seedAt("b", {10, 6.4, 6.4});
  orphan.parent = "nobody";
  EXPECT_THROW(further(t.volume, t.known, {orphan}), Error);
  orphan.parent = "b";
  circle.parent = "child";
  EXPECT_THROW(further(t.volume, t.known, {orphan, circle}), Error);
}

TEST(TrackFurther, ThreadsMakeNoDifference) {
  const Tee t;
  const std::vector<SeedBranch> seeds{childSeed(), seedAt("again", {6.4, 6.4, 9})};
  Case one;
  {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    one = further(t.volume, t.known, seeds).result;
  }
  EXPECT_EQ(further(t.volume, t.known, seeds).result, one);
}

TEST(TrackFurther, StopsWhenCancelled) {
  const Tee t;
  Progress progress;
  const TrackingVolume volume(t.volume, t.known, progress);
  progress.cancel();
  EXPECT_THROW(addTracksFromSeeds(volume, t.known, {childSeed()}, progress), Error);
}

TEST(TrackingVolume, HasTheOptionsThatACaseWasTrackedWith) {
  const Volume volume = tee(0.6);
  TrackOptions options;
  options.inlierRate = 0.65;
  options.rays = 42;
  options.lookAhead = 2;
  options.seed = 7;
  options.smoothing = 0.1;
  options.evenBlur = false;
  Progress silent;
  const Case known =
      trackFromSeeds(volume, {seedAt("trunk", {6.4, 6.4, 3})}, options, silent).result;
  const auto recorded = recordedTrackOptions(known);
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->parameters(), known.metadata.steps[0].parameters);
  const TrackingVolume tracking(volume, known, silent);
  EXPECT_EQ(tracking.options().parameters(), known.metadata.steps[0].parameters);
}

TEST(TrackingVolume, RefusesACaseThatWasNotTracked) {
  Tee t;
  t.known.metadata.steps.clear();
  Progress silent;
  EXPECT_THROW(TrackingVolume(t.volume, t.known, silent), Error);
}

TEST(TrackingVolume, RefusesOptionsOutOfRange) {
  Tee t;
  t.known.metadata.steps[0].parameters["rays"] = std::int64_t{100};
  Progress silent;
  EXPECT_THROW(TrackingVolume(t.volume, t.known, silent), Error);
}

/// A sac on a bend whose vessel is tracked; the truth has both.
struct SacBeside {
  Phantom phantom;
  Case known;
  std::vector<SeedBranch> sac;

  SacBeside() {
    PhantomOptions options;
    options.name = "aneurysm";
    Progress silent;
    phantom = makePhantom(options, silent);
    std::vector<SeedBranch> vessels;
    for (const SeedBranch& seed : phantom.seeds)
      (seed.kind == formats::BranchKind::Aneurysm ? sac : vessels).push_back(seed);
    known = trackFromSeeds(phantom.volume, vessels, TrackOptions{}, silent).result;
  }
};

TEST(TrackFurther, GivesAnAneurysmItsWallAndItsVesselAnOpenNeck) {
  const SacBeside s;
  ASSERT_EQ(s.sac.size(), 1U);
  const AddedTracks out = further(s.phantom.volume, s.known, s.sac);
  ASSERT_GT(out.result.tree.branches.size(), out.firstNewBranch);
  const auto& sac = out.result.tree.branches[out.firstNewBranch];
  EXPECT_EQ(sac.kind, formats::BranchKind::Aneurysm);
  EXPECT_NE(sac.parentNode, kNoParent);
  // as when all is tracked at once
  Progress silent;
  const Case whole =
      trackFromSeeds(s.phantom.volume, s.phantom.seeds, TrackOptions{}, silent).result;
  const auto at =
      std::find_if(whole.tree.branches.begin(), whole.tree.branches.end(),
                   [](const auto& b) { return b.kind == formats::BranchKind::Aneurysm; });
  ASSERT_NE(at, whole.tree.branches.end());
  ASSERT_EQ(sac.nodeCount, at->nodeCount);
  const auto pointsOf = [](const Case& value, std::uint32_t node) {
    return static_cast<double>(value.points->offset[node + 1] - value.points->offset[node]);
  };
  for (std::uint32_t i = 0; i < sac.nodeCount; ++i) {
    EXPECT_NEAR(out.result.tree.radius[sac.firstNode + i], whole.tree.radius[at->firstNode + i],
                0.02);
    EXPECT_NEAR(pointsOf(out.result, sac.firstNode + i) / pointsOf(whole, at->firstNode + i), 1,
                0.1);
  }
  // the vessel's nodes stay, but for wall points at the neck
  EXPECT_FALSE(out.changed.empty());
  EXPECT_LT(out.changed.size(), s.known.tree.nodeCount() / 2);
  EXPECT_TRUE(std::equal(s.known.tree.centre.begin(), s.known.tree.centre.end(),
                         out.result.tree.centre.begin()));
  EXPECT_TRUE(std::equal(s.known.tree.radius.begin(), s.known.tree.radius.end(),
                         out.result.tree.radius.begin()));
}

}  // namespace
}  // namespace lumen::convert
