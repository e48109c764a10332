// SPDX-License-Identifier: Apache-2.0
// As a person works: the check says which vessel is missing, a click on it tracks it, what is new is fitted,
// and the check finds it no more; a branch is cut, and cut off, and only what changed is fitted.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/io/volume/read_volume.h"
#include "converters/judge/check/check.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/tracking/vessel_at_click.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "formats/case/topology.h"
#include "formats/case/validate.h"

namespace lumen::convert {
namespace {

using formats::Case;

Case converted(const Volume& volume, const std::vector<SeedBranch>& seeds) {
  Progress silent;
  Case value = trackFromSeeds(volume, seeds, TrackOptions{}, silent).result;
  fit(value, {}, silent);
  return value;
}

std::vector<std::uint32_t> staleAfter(const Case& before, const AddedTracks& tracks) {
  std::vector<std::uint32_t> nodeBefore(tracks.result.tree.nodeCount(), kNewNode);
  for (std::uint32_t n = 0; n < tracks.firstNewNode; ++n) nodeBefore[n] = n;
  return staleNodes(before, tracks.result, nodeBefore);
}

void expectReachable(const Case& value) {
  const auto valid = formats::validate(value);
  ASSERT_TRUE(valid) << valid.error().text();
  const auto reach = formats::measureReachability(value.tree, formats::caseField(value));
  EXPECT_EQ(reach.reachable, reach.total);
}

/// Nodes of two cases that have the same blobs under the same index.
std::size_t sameModels(const Case& a, const Case& b, std::size_t nodes) {
  std::size_t same = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto blobs = [n](const Case& value) {
      const auto& m = *value.models;
      std::vector<formats::Vec3f> centres(m.centre.begin() + m.offset[n],
                                          m.centre.begin() + m.offset[n + 1]);
      return centres;
    };
    same += blobs(a) == blobs(b);
  }
  return same;
}

/// The fork of 70 degrees, of which one arm was not clicked.
struct Fork {
  Phantom phantom;
  Case value;

  Fork() {
    PhantomOptions options;
    options.name = "bifurcation";
    Progress silent;
    phantom = makePhantom(options, silent);
    phantom.seeds.resize(phantom.seeds.size() - 1);
    value = converted(phantom.volume, phantom.seeds);
  }
};

TEST(OneClick, TracksWhatTheCheckMisses) {
  const Fork fork;
  Progress silent;
  const EdgeOptions edges = recordedEdgeOptions(fork.value);
  const auto before = checkCase(fork.phantom.volume, fork.value, edges, silent).report;
  ASSERT_FALSE(before.missing.vessels.empty());
  ASSERT_GT(before.missingLength(), 5);

  const Clicks clicks = clicksOn(before.missing.vessels[0]);
  const TrackingVolume volume(fork.phantom.volume, fork.value, silent);
  const VesselAtClick vessel = vesselAtClick(volume, clicks.points[0]);
  EXPECT_TRUE(vessel.found) << vessel.reason;
  SeedBranch seed;
  seed.label = "missed";
  for (const Eigen::Vector3d& p : clicks.points) seed.points.push_back({p, std::nullopt});
  const AddedTracks tracks = addTracksFromSeeds(volume, fork.value, {seed}, silent);
  ASSERT_TRUE(tracks.failures.empty()) << tracks.failures[0].reason;
  EXPECT_TRUE(tracks.missedPoints.empty());

  Case value = tracks.result;
  const auto stale = staleAfter(fork.value, tracks);
  refit(value, stale, recordedFitOptions(value), silent);
  ASSERT_EQ(value.tree.branches.back().label, "missed");
  EXPECT_NE(value.tree.branches.back().parentNode, formats::kNoParent);
  expectReachable(value);
  // only the nodes around the joint are fitted anew; an opening may add a blob to few others
  const std::size_t old = fork.value.tree.nodeCount(), fresh = value.tree.nodeCount() - old;
  EXPECT_LE(stale.size(), fresh + 10);
  EXPECT_GE(sameModels(fork.value, value, old), old - (stale.size() - fresh) - 4);
  const auto after = checkCase(fork.phantom.volume, value, edges, silent).report;
  EXPECT_LT(after.missingLength(), 1);
}

TEST(OneClick, IsTakenBackByDeletingTheBranch) {
  const Fork fork;
  Progress silent;
  const auto& truth = fork.phantom.truth.tree;
  SeedBranch seed;
  seed.label = "arm";
  const auto& branch = truth.branches.back();
  seed.points.push_back(
      {toEigen(truth.centre[branch.firstNode + branch.nodeCount / 2]), std::nullopt});
  const TrackingVolume volume(fork.phantom.volume, fork.value, silent);
  const AddedTracks tracks = addTracksFromSeeds(volume, fork.value, {seed}, silent);
  Case value = tracks.result;
  refit(value, staleAfter(fork.value, tracks), recordedFitOptions(value), silent);
  const Change change = deleteBranch(value, tracks.firstNewBranch);
  refit(value, change.stale, recordedFitOptions(value), silent);
  EXPECT_EQ(value.tree, fork.value.tree);
  EXPECT_EQ(value.points, fork.value.points);
  expectReachable(value);
}

TEST(Corrections, LeaveATreeThatIsReachableOnceWhatTheyChangedIsFitted) {
  const Fork fork;
  Progress silent;
  Case value = fork.value;
  const auto fitted = [&](const Change& change) {
    refit(value, change.stale, recordedFitOptions(value), silent);
    expectReachable(value);
  };
  const std::uint32_t middle =
      value.tree.branches[0].firstNode + value.tree.branches[0].nodeCount / 2;
  fitted(cutBefore(value, middle));
  fitted(joinBranch(value, 1, middle - 1));
  fitted(moveNode(value, middle / 2, toEigen(value.tree.centre[middle / 2]),
                  1.3 * double{value.tree.radius[middle / 2]}));
  fitted(makeRoot(value, 1));
  fitted(setKind(value, 0, formats::BranchKind::Aneurysm));
}

TEST(Corrections, MakeTheVesselAsWideAsAMovedNodeStates) {
  const Fork fork;
  Progress silent;
  Case value = fork.value;
  const std::uint32_t node = value.tree.branches[0].nodeCount / 3;
  const double radius = 1.3 * double{value.tree.radius[node]};
  const Change change = moveNode(value, node, toEigen(value.tree.centre[node]), radius);
  refit(value, change.stale, recordedFitOptions(value), silent);
  // the wall at the node, in the middle between where it was and is said to be, or farther
  const auto field = formats::caseField(value);
  const Eigen::Vector3d centre = toEigen(value.tree.centre[node]);
  const auto [u, v] = planeBasis(toEigen(value.tree.direction[node]));
  int within = 0;
  for (int i = 0; i < 16; ++i) {
    const double a = 0.3926991 * i;
    const Eigen::Vector3d p = centre + radius / 1.3 * 1.15 * (std::cos(a) * u + std::sin(a) * v);
    within += field.blended<1>({p.x(), p.y(), p.z()}, node).value > field.level();
  }
  EXPECT_GE(within, 14);
}

TEST(OneClick, OnAReal3draJoinsItsVesselToTheTree) {
  const auto file = std::filesystem::path(LUMEN_SHARED_DATA) / "aneurism-3dra.nrrd";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "aneurism-3dra.nrrd is not here";
  Progress silent;
  const Volume volume = readVolume(file, VolumeFormat::Nrrd, ReadVolumeOptions{}, silent);
  auto seeds = readSeeds(std::filesystem::path(LUMEN_TEST_DATA) / "aneurism-3dra.seeds.json");
  // the carotid, and one that leaves it
  std::erase_if(seeds, [](const SeedBranch& seed) {
    return seed.label != "ica" && seed.label != "ica-branch-1";
  });
  SeedBranch click = seeds.back();
  ASSERT_EQ(click.label, "ica-branch-1");
  seeds.pop_back();
  const Case known = converted(volume, seeds);
  const TrackingVolume tracking(volume, known, silent);
  click.parent.reset();
  click.points.resize(1);
  const AddedTracks tracks = addTracksFromSeeds(tracking, known, {click}, silent);
  ASSERT_TRUE(tracks.failures.empty()) << tracks.failures[0].reason;
  Case value = tracks.result;
  refit(value, staleAfter(known, tracks), recordedFitOptions(value), silent);
  const formats::Branch& branch = value.tree.branches.back();
  EXPECT_GT(formats::branchLength(value.tree, branch), 50);
  ASSERT_NE(branch.parentNode, formats::kNoParent);
  EXPECT_EQ(
      value.tree.branches[value.tree.branch[static_cast<std::size_t>(branch.parentNode)]].label,
      "ica");
  expectReachable(value);
}

}  // namespace
}  // namespace lumen::convert
