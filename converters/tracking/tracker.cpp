// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "converters/common/vectors.h"
#include "converters/tracking/aneurysm.h"
#include "converters/tracking/bends.h"
#include "converters/tracking/branch_tracker.h"
#include "converters/tracking/joining.h"
#include "converters/tracking/point_spread.h"
#include "converters/tracking/smoothing.h"
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

/// For every seed, its parent's position in the list (-1: none) and its depth below a root.
struct Ancestry {
  std::vector<int> parent, depth;
  int deepest = 0;

  [[nodiscard]] std::size_t rootOf(std::size_t i) const {
    while (parent[i] >= 0) i = static_cast<std::size_t>(parent[i]);
    return i;
  }
};

Ancestry findAncestry(const std::vector<SeedBranch>& seeds) {
  std::unordered_map<std::string, int> position;
  Ancestry out;
  for (const SeedBranch& seed : seeds) {
    const int parent = seed.parent ? position.at(*seed.parent) : -1;
    position[seed.label] = static_cast<int>(out.parent.size());
    out.parent.push_back(parent);
    out.depth.push_back(parent < 0 ? 0 : out.depth[static_cast<std::size_t>(parent)] + 1);
    out.deepest = std::max(out.deepest, out.depth.back());
  }
  return out;
}

/// Cuts off what an earlier branch of the same wave has tracked too, on either side of the click.
void trimDuplicates(std::vector<TrackedBranch>& branches, const std::vector<std::size_t>& wave) {
  std::vector<const TrackedBranch*> kept;
  for (const std::size_t b : wave) {
    TrackedBranch& branch = branches[b];
    auto& nodes = branch.nodes;
    const auto met = [&](const TrackedNode& n) { return inCore(kept, n.centre); };
    const auto click = nodes.begin() + static_cast<std::ptrdiff_t>(branch.clickNode);
    const auto end = std::find_if(click, nodes.end(), met);
    if (end != nodes.end()) branch.stopReason = StopReason::MetBranch;
    if (end == click && !nodes.empty()) branch.failure = kTrackedAlready;
    const auto begin = std::find_if(std::make_reverse_iterator(click), nodes.rend(), met).base();
    nodes.erase(end, nodes.end());
    nodes.erase(nodes.begin(), end == click ? nodes.end() : begin);
    kept.push_back(&branch);
  }
}

/// One wave: all branches whose parents are done. Branches of a wave do not see one another while
/// they are tracked, so the outcome does not depend on the order in which threads take them.
void trackWave(const TrackContext& context, const std::vector<SeedBranch>& seeds,
               const Ancestry& ancestry, int depth, std::vector<TrackedBranch>& branches,
               Progress& progress) {
  std::vector<std::size_t> wave;
  std::vector<const TrackedBranch*> finished;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (ancestry.depth[i] == depth) wave.push_back(i);
    if (ancestry.depth[i] < depth && seeds[i].kind == BranchKind::Vessel)
      finished.push_back(&branches[i]);
  }
  tbb::parallel_for(std::size_t{0}, wave.size(), [&](std::size_t w) {
    const std::size_t i = wave[w];
    const int p = ancestry.parent[i];
    const TrackedBranch* parent = p < 0 ? nullptr : &branches[static_cast<std::size_t>(p)];
    if (parent && parent->nodes.empty()) {
      branches[i].failure =
          "its parent \"" + formats::printable(*seeds[i].parent) + "\" was not tracked";
    } else if (seeds[i].kind == BranchKind::Aneurysm) {
      branches[i] = captureAneurysm(context, seeds[i], parent);
    } else {
      branches[i] =
          trackBranch(context, seeds[i], parent, finished, Random(context.options.seed, i));
    }
    branches[i].parentBranch = p;
    progress.advance();
  });
  std::erase_if(wave, [&](std::size_t i) { return seeds[i].kind != BranchKind::Vessel; });
  trimDuplicates(branches, wave);
}

/// Fills the gaps of all vessels, then leads children to their parents, those first that have
/// arrived themselves.
void joinAll(const TrackContext& context, const std::vector<SeedBranch>& seeds,
             const Ancestry& ancestry, std::vector<TrackedBranch>& branches) {
  const auto eachVessel = [&](int depth, const auto& action) {
    tbb::parallel_for(std::size_t{0}, branches.size(), [&](std::size_t i) {
      const bool isDue = depth < 0 || ancestry.depth[i] == depth;
      if (!isDue || branches[i].nodes.empty() || seeds[i].kind != BranchKind::Vessel) return;
      TrackWorkspace workspace(context);
      Random random(context.options.seed,
                    branches.size() * static_cast<std::size_t>(depth + 2) + i);
      action(branches[i], random, workspace);
    });
  };
  eachVessel(-1, [&](TrackedBranch& branch, Random& random, TrackWorkspace& workspace) {
    fillGaps(context, branch, random, workspace);
  });
  for (int depth = 1; depth <= ancestry.deepest; ++depth)
    eachVessel(depth, [&](TrackedBranch& branch, Random& random, TrackWorkspace& workspace) {
      std::vector<int> others;
      for (std::size_t i = 0; i < branches.size(); ++i)
        if (ancestry.depth[i] < depth && seeds[i].kind == BranchKind::Vessel &&
            ancestry.rootOf(i) == ancestry.rootOf(static_cast<std::size_t>(branch.parentBranch)))
          others.push_back(static_cast<int>(i));
      joinToParent(context, branches, others, branch, random, workspace);
    });
  for (std::size_t i = 0; i < branches.size(); ++i) {
    TrackedBranch& branch = branches[i];
    if (seeds[i].kind != BranchKind::Aneurysm || branch.parentBranch < 0 || branch.nodes.empty())
      continue;
    const auto& parent = branches[static_cast<std::size_t>(branch.parentBranch)];
    branch.parentNode = static_cast<int>(closestOnChain(parent.nodes, branch.nodes[0].centre).node);
  }
}

/// All branches, in the seeds' order but for parents that come after a child.
std::vector<std::size_t> parentsFirst(const std::vector<TrackedBranch>& branches) {
  std::vector<std::size_t> order;
  std::vector<bool> isPlaced(branches.size(), false);
  while (order.size() < branches.size())
    for (std::size_t i = 0; i < branches.size(); ++i) {
      const int parent = branches[i].parentBranch;
      if (isPlaced[i] || (parent >= 0 && !isPlaced[static_cast<std::size_t>(parent)])) continue;
      isPlaced[i] = true;
      order.push_back(i);
    }
  return order;
}

/// Appends one tracked branch to the case. `firstNode`: of each branch by position in the seeds.
void appendBranch(const SeedBranch& seed, const TrackedBranch& branch,
                  const std::vector<std::int32_t>& firstNode, formats::Case& out) {
  formats::CenterlineTree& tree = out.tree;
  const auto first = static_cast<std::int32_t>(tree.nodeCount());
  if (branch.nodes.empty()) return;
  formats::Branch record;
  record.label = seed.label;
  record.kind = seed.kind;
  record.firstNode = static_cast<std::uint32_t>(first);
  record.nodeCount = static_cast<std::uint32_t>(branch.nodes.size());
  record.stopReason = branch.stopReason;
  if (branch.parentBranch >= 0)
    record.parentNode =
        firstNode[static_cast<std::size_t>(branch.parentBranch)] + branch.parentNode;
  double rates = 0;
  for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
    const TrackedNode& node = branch.nodes[i];
    tree.centre.push_back(toVec3f(node.centre));
    tree.direction.push_back(toVec3f(node.direction));
    tree.radius.push_back(static_cast<float>(node.radius));
    tree.height.push_back(static_cast<float>(node.height));
    tree.inlierRate.push_back(static_cast<float>(node.inlierRate));
    tree.parent.push_back(i == 0 ? record.parentNode : first + static_cast<std::int32_t>(i) - 1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    rates += node.inlierRate;
    auto& points = *out.points;
    points.position.insert(points.position.end(), node.points.begin(), node.points.end());
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  record.meanInlierRate = static_cast<float>(rates / static_cast<double>(branch.nodes.size()));
  tree.branches.push_back(std::move(record));
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

}  // namespace

TrackResult track(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress) {
  options.check(volume.geometry.spacing.minCoeff());
  checkVoxels(volume.geometry.spacing);
  warnOfOtherSign(volume, seeds, options, progress);
  const SmoothedVolume smoothed = smoothForNoise(volume, seeds, options, progress);
  const TrackContext context(*smoothed.spline, options, smoothed.noiseFloor, progress);
  const Ancestry ancestry = findAncestry(seeds);
  std::vector<TrackedBranch> branches(seeds.size());
  progress.begin("track", seeds.size());
  for (int depth = 0; depth <= ancestry.deepest; ++depth)
    trackWave(context, seeds, ancestry, depth, branches, progress);
  joinAll(context, seeds, ancestry, branches);
  reviewWalls(context, seeds, branches);
  progress.end();
  TrackOptions used = options;
  used.smoothing = smoothed.smoothing;
  const WallShape shape = wallShapeOf(smoothed, seeds, branches, options);
  used.pointSpread = shape.pointSpread;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    correctWalls(branches[i], seeds[i].kind, shape);
    if (seeds[i].kind == BranchKind::Vessel) correctBends(branches[i].nodes);
  }

  TrackResult out;
  out.result.points.emplace();
  out.result.points->offset.push_back(0);
  std::vector<std::int32_t> firstNode(seeds.size());
  std::vector<formats::NodeOrigin> origins;
  for (const std::size_t i : parentsFirst(branches)) {
    firstNode[i] = static_cast<std::int32_t>(out.result.tree.nodeCount());
    appendBranch(seeds[i], branches[i], firstNode, out.result);
    for (const TrackedNode& node : branches[i].nodes) origins.push_back(node.origin);
    if (branches[i].nodes.empty()) out.failures.push_back({seeds[i].label, branches[i].failure});
    for (const std::string& missed : branches[i].missedPoints)
      out.missedPoints.push_back({seeds[i].label, missed});
  }
  setNodeOrigins(out.result, origins);
  out.result.metadata.voxelSize = volume.geometry.voxelSize();
  out.result.metadata.source = describeSource(volume);
  out.result.metadata.steps.push_back({"track", "lumen " LUMEN_VERSION, used.parameters()});
  return out;
}

}  // namespace lumen::convert
