// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/vessel_tracks.h"

#include "converters/stages/tracking/bends.h"
#include "converters/stages/tracking/sac_walls.h"
#include "converters/stages/tracking/track_waves.h"
#include "converters/stages/tracking/tree_joins.h"
#include "converters/stages/tracking/wall_review.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

/// Gives the wall points that a sac has added to known vessels, behind those that they kept, their true
/// place. `before`: the points that the nodes had.
void correctAdded(TrackedBranch& branch, const TrackedBranch& before, BranchKind kind,
                  const WallShape& shape) {
  for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
    auto& points = branch.nodes[n].points;
    auto kept = points.begin();
    for (const formats::Vec3f& p : before.nodes[n].points)
      if (kept != points.end() && *kept == p) ++kept;
    if (kept == points.end()) continue;
    TrackedBranch added;
    added.nodes.push_back(branch.nodes[n]);
    added.nodes[0].points.assign(kept, points.end());
    correctWalls(added, kind, shape);
    std::copy(added.nodes[0].points.begin(), added.nodes[0].points.end(), kept);
  }
}

/// Adds what became of one seed.
void remark(const SeedBranch& seed, const TrackedBranch& branch, TrackRemarks& out) {
  if (branch.nodes.empty()) {
    out.failures.push_back({seed.label, branch.failure});
    return;
  }
  for (const std::string& missed : branch.missedPoints)
    out.missedPoints.push_back({seed.label, missed});
  if (seed.kind != BranchKind::Vessel) return;
  if (!branch.unjoined.empty()) out.unjoined.push_back({seed.label, branch.unjoined});
  if (branch.parentBranch < 0 && branch.startReason != StopReason::Unknown)
    out.ends.push_back(
        {seed.label, true, branch.startReason, branch.nodes.front().centre, branch.startGoesOn});
  out.ends.push_back(
      {seed.label, false, branch.stopReason, branch.nodes.back().centre, branch.goesOn});
}

}  // namespace

WallShape trackVessels(const TrackingVolume& volume, const std::vector<SeedBranch>& seeds,
                       std::size_t known, std::vector<TrackedBranch>& branches,
                       Progress& progress) {
  const TrackContext context(volume.spline(), volume.options(), volume.noiseFloor(), progress);
  progress.begin("track", seeds.size() - known);
  trackAll(context, seeds, SeedTree(seeds), known, branches, progress);
  goOnwardAll(context, seeds, known, branches);
  joinAll(context, seeds, known, branches);
  reviewWalls(context, seeds, known, branches);
  progress.end();
  const WallShape shape =
      volume.wallShape() ? *volume.wallShape() : wallShapeOf(volume, seeds, branches);
  const std::vector<TrackedBranch> before(branches.begin(),
                                          branches.begin() + static_cast<std::ptrdiff_t>(known));
  captureSacs(context, seeds, known, branches);
  for (std::size_t i = 0; i < known; ++i)
    correctAdded(branches[i], before[i], seeds[i].kind, shape);
  for (std::size_t i = known; i < seeds.size(); ++i) {
    correctWalls(branches[i], seeds[i].kind, shape);
    if (seeds[i].kind == BranchKind::Vessel) correctBends(branches[i].nodes);
  }
  return shape;
}

TrackRemarks remarksOn(const std::vector<SeedBranch>& seeds,
                       const std::vector<TrackedBranch>& branches, std::size_t known) {
  TrackRemarks out;
  for (std::size_t i = known; i < seeds.size(); ++i) remark(seeds[i], branches[i], out);
  return out;
}

}  // namespace lumen::convert
