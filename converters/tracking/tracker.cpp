// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "converters/tracking/bends.h"
#include "converters/tracking/case_of_tracks.h"
#include "converters/tracking/point_spread.h"
#include "converters/tracking/sac_walls.h"
#include "converters/tracking/smoothing.h"
#include "converters/tracking/track_waves.h"
#include "converters/tracking/tree_joins.h"
#include "converters/tracking/wall_review.h"
#include "converters/volume/write_volume.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

/// The variance of a box is the square of its edge over this.
constexpr double kEdgesToVariance = 12.0;

/// The most that one edge of a voxel may be of another: beyond, rays of a vessel's size cross nothing
/// along the one axis and thousands of voxels along the other.
constexpr double kMostUneven = 1000.0;

void checkVoxels(const Eigen::Vector3d& spacing) {
  const double uneven = spacing.maxCoeff() / spacing.minCoeff();
  if (uneven <= kMostUneven) return;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "the volume's voxels are %g x %g x %g mm, one edge %.3g times another; expected at "
                "most %g times: if the spacing is wrong, --spacing states it, else resample",
                spacing.x(), spacing.y(), spacing.z(), uneven, kMostUneven);
  throw invalidInput(text.data());
}

/// Times the contrast of the vessels as they should be: if they have so much the other way, they are
/// the other way.
constexpr double kOtherWay = 4.0;

void warnOfOtherSign(const Volume& volume, const std::vector<SeedBranch>& seeds,
                     const TrackOptions& options, Progress& progress) {
  const Eigen::Vector3d& spacing = volume.geometry.spacing;
  const double most = BsplineVolume::kMostSmoothing * spacing.minCoeff();
  const BsplineVolume spline(
      volume, Eigen::Vector3d::Constant(std::min(volume.geometry.voxelSize(), most)));
  TrackOptions other = options;
  other.dark = !options.dark;
  const double contrast = contrastAtClicks(spline, seeds, options, progress);
  if (contrastAtClicks(spline, seeds, other, progress) <= kOtherWay * contrast) return;
  progress.warn(
      options.dark ? "most seeds lie where it is brighter than around them, but --dark tracks dark "
                     "vessels: leave it out if vessels are bright"
                   : "most seeds lie where it is darker than around them: if vessels are dark, add "
                     "--dark");
}

/// By what walls are corrected: the blur as given, then nothing else is; or as measured, or at least
/// that of the voxel's own box and of the smoothing.
WallShape wallShapeOf(const SmoothedVolume& volume, const std::vector<SeedBranch>& seeds,
                      const std::vector<TrackedBranch>& branches, const TrackOptions& options) {
  if (options.pointSpread) return {*options.pointSpread, 0};
  std::vector<const TrackedBranch*> vessels;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i].kind == BranchKind::Vessel) vessels.push_back(&branches[i]);
  const VolumeGeometry& geometry = volume.spline->geometry();
  const double edge = options.evenBlur ? geometry.spacing.maxCoeff() : geometry.voxelSize();
  const double least =
      std::sqrt(volume.smoothing * volume.smoothing + edge * edge / kEdgesToVariance);
  return measureWalls(*volume.spline, vessels, options.dark).value_or(WallShape{least, 0});
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

TrackResult track(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress) {
  options.check(volume.geometry.spacing.minCoeff());
  checkVoxels(volume.geometry.spacing);
  warnOfOtherSign(volume, seeds, options, progress);
  const SmoothedVolume smoothed = smoothForNoise(volume, seeds, options, progress);
  const TrackContext context(*smoothed.spline, options, smoothed.noiseFloor, progress);
  progress.begin("track", seeds.size());
  std::vector<TrackedBranch> branches = trackAll(context, seeds, SeedTree(seeds), progress);
  goOnwardAll(context, seeds, branches);
  joinAll(context, seeds, branches);
  reviewWalls(context, seeds, branches);
  progress.end();
  TrackOptions used = options;
  used.smoothing = smoothed.smoothing;
  const WallShape shape = wallShapeOf(smoothed, seeds, branches, options);
  used.pointSpread = shape.pointSpread;
  captureSacs(context, seeds, branches);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    correctWalls(branches[i], seeds[i].kind, shape);
    if (seeds[i].kind == BranchKind::Vessel) correctBends(branches[i].nodes);
  }

  TrackResult out;
  out.result = caseOfTracks(seeds, branches);
  for (std::size_t i = 0; i < seeds.size(); ++i) remark(seeds[i], branches[i], out);
  out.result.metadata.voxelSize = volume.geometry.voxelSize();
  out.result.metadata.source = describeSource(volume);
  out.result.metadata.steps.push_back({"track", "lumen " LUMEN_VERSION, used.parameters()});
  return out;
}

}  // namespace lumen::convert
