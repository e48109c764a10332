// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_waves.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/stages/tracking/aneurysm.h"
#include "converters/stages/tracking/branch_tracker.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

/// Of a radius: a click that is nearer to a vessel's axis is on that vessel.
constexpr double kOnAxis = 0.5;
/// Of the vessel's radius: a click that states less is on one of its branches.
constexpr double kOwnRadius = 0.6;
/// Nodes that a tail needs beyond the clicks of the vessel that it is taken from.
constexpr std::size_t kBeyondClicks = 2;

double lengthOf(std::span<const TrackedNode> nodes) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    length += (nodes[i].centre - nodes[i - 1].centre).norm();
  return length;
}

/// The seeds of a wave and what was tracked before them.
struct Wave {
  const std::vector<SeedBranch>& seeds;
  std::vector<TrackedBranch>& branches;
  std::size_t known;                       ///< seeds that were tracked before all waves
  std::vector<std::size_t> members = {};   ///< in the seeds' order
  std::vector<std::size_t> finished = {};  ///< vessels with nodes

  [[nodiscard]] bool isVessel(std::size_t i) const { return seeds[i].kind == BranchKind::Vessel; }
};

/// The nearest ancestor that has nodes, or the branch that one of them was tracked as part of; -1 if
/// there is none.
int trackedAncestor(const SeedTree& tree, const std::vector<TrackedBranch>& branches,
                    std::size_t seed) {
  int above = tree.parent[seed];
  while (above >= 0) {
    const TrackedBranch& branch = branches[static_cast<std::size_t>(above)];
    if (!branch.nodes.empty()) return above;
    if (branch.trackedBy >= 0) return branch.trackedBy;
    above = tree.parent[static_cast<std::size_t>(above)];
  }
  return -1;
}

/// Where a vessel holds a click, as its node; empty if the click is not near its axis, or says that
/// it is on another vessel.
std::optional<std::size_t> nodeAtClick(const TrackedBranch& vessel, const SeedBranch& seed,
                                       const Eigen::Vector3d& click) {
  const ChainPoint at = closestOnChain(vessel.nodes, click);
  if (at.distance > kOnAxis * at.radius) return std::nullopt;
  if (seed.points[0].radius && *seed.points[0].radius < kOwnRadius * at.radius) return std::nullopt;
  return at.node;
}

/// The last node that one of the seed's own points lies at.
std::size_t lastClickNode(const TrackedBranch& branch, const SeedBranch& seed) {
  std::size_t last = branch.clickNode;
  for (const SeedPoint& point : seed.points) {
    const ChainPoint at = closestOnChain(branch.nodes, point.position);
    if (at.distance < at.radius) last = std::max(last, at.node);
  }
  return last;
}

/// A vessel that has run on into the one that a later seed names keeps what is before that one's
/// click; the rest is the later seed's, which keeps its own track from the click on if that is
/// longer. `node`: of the vessel, at the click.
void giveTail(std::vector<TrackedBranch>& branches, int from, std::size_t node,
              TrackedBranch& taker) {
  TrackedBranch& giver = branches[static_cast<std::size_t>(from)];
  const std::size_t click = std::min(taker.clickNode, taker.nodes.size());
  const auto own = std::span(taker.nodes).subspan(click);
  const auto tail = std::span(giver.nodes).subspan(node);
  if (own.size() > 1 && lengthOf(own) >= lengthOf(tail)) {
    taker.nodes.erase(taker.nodes.begin(),
                      taker.nodes.begin() + static_cast<std::ptrdiff_t>(click));
  } else {
    taker.nodes.assign(tail.begin(), tail.end());
    taker.stopReason = giver.stopReason;
  }
  taker.clickNode = 0;
  taker.failure.clear();
  taker.startReason = StopReason::Unknown;
  taker.isTail = true;
  taker.parentBranch = from;
  giver.nodes.resize(node);
  giver.stopReason = StopReason::MetBranch;
}

/// Gives the members of a wave what vessels of their tree have tracked beyond their clicks.
void giveTails(const Wave& wave) {
  std::vector<std::size_t> givers = wave.finished;
  for (const std::size_t i : wave.members) {
    TrackedBranch& branch = wave.branches[i];
    const SeedBranch& seed = wave.seeds[i];
    const Eigen::Vector3d click =
        branch.nodes.empty() ? seed.points[0].position : branch.nodes[branch.clickNode].centre;
    for (const std::size_t g : givers) {
      TrackedBranch& giver = wave.branches[g];
      if (giver.nodes.empty()) continue;
      const auto node = nodeAtClick(giver, seed, click);
      if (!node) continue;
      const bool isBeyond =
          g >= wave.known && *node > lastClickNode(giver, wave.seeds[g]) + kBeyondClicks;
      if (seed.parent && isBeyond && *node + 1 < giver.nodes.size())
        giveTail(wave.branches, static_cast<int>(g), *node, branch);
      else if (branch.nodes.empty())
        branch.trackedBy = static_cast<int>(g);
      break;
    }
    givers.push_back(i);
  }
}

/// The first of some branches whose core a node lies in; -1 if there is none.
int holderOf(const Wave& wave, std::span<const std::size_t> others, const TrackedNode& node) {
  for (const std::size_t other : others) {
    const TrackedBranch* branch = &wave.branches[other];
    if (inCore({&branch, 1}, node)) return static_cast<int>(other);
  }
  return -1;
}

/// Cuts off what an earlier branch of the same wave has tracked too, on either side of the click.
void trimDuplicates(const Wave& wave) {
  std::vector<std::size_t> kept;
  for (const std::size_t b : wave.members) {
    TrackedBranch& branch = wave.branches[b];
    auto& nodes = branch.nodes;
    if (nodes.empty()) continue;
    std::vector<std::size_t> others = kept;
    if (branch.isTail) std::erase(others, static_cast<std::size_t>(branch.parentBranch));
    const auto met = [&](const TrackedNode& n) { return holderOf(wave, others, n) >= 0; };
    const auto click = nodes.begin() + static_cast<std::ptrdiff_t>(branch.clickNode);
    const auto end = std::find_if(click, nodes.end(), met);
    const auto begin = std::find_if(std::make_reverse_iterator(click), nodes.rend(), met).base();
    const auto cut = static_cast<std::size_t>(begin - nodes.begin());
    if (end != nodes.end()) branch.stopReason = StopReason::MetBranch;
    if (cut > 0) branch.startReason = StopReason::MetBranch;
    if (end == click) {
      branch.failure = kTrackedAlready;
      branch.trackedBy = holderOf(wave, others, *click);
      nodes.clear();
    } else {
      nodes.erase(end, nodes.end());
      nodes.erase(nodes.begin(), begin);
      branch.clickNode -= cut;
    }
    kept.push_back(b);
  }
}

void trackWave(const TrackContext& context, const SeedTree& tree, Wave& wave, Progress& progress) {
  std::vector<const TrackedBranch*> finished;
  for (const std::size_t i : wave.finished) finished.push_back(&wave.branches[i]);
  tbb::parallel_for(std::size_t{0}, wave.members.size(), [&](std::size_t w) {
    const std::size_t i = wave.members[w];
    const SeedBranch& seed = wave.seeds[i];
    const int p = trackedAncestor(tree, wave.branches, i);
    const TrackedBranch* parent = p < 0 ? nullptr : &wave.branches[static_cast<std::size_t>(p)];
    TrackedBranch branch = wave.isVessel(i) ? trackBranch(context, seed, parent, finished,
                                                          Random(context.options.seed, i))
                                            : captureAneurysm(context, seed, parent);
    branch.parentBranch = p;
    wave.branches[i] = std::move(branch);
    progress.advance();
  });
  std::erase_if(wave.members, [&](std::size_t i) { return !wave.isVessel(i); });
  giveTails(wave);
  trimDuplicates(wave);
}

}  // namespace

void trackAll(const TrackContext& context, const std::vector<SeedBranch>& seeds,
              const SeedTree& tree, std::size_t known, std::vector<TrackedBranch>& branches,
              Progress& progress) {
  branches.resize(seeds.size());
  for (int depth = 0; depth <= tree.deepest; ++depth) {
    Wave wave{seeds, branches, known};
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const bool isDone = i < known || tree.depth[i] < depth;
      if (!isDone && tree.depth[i] == depth) wave.members.push_back(i);
      if (isDone && wave.isVessel(i) && !branches[i].nodes.empty()) wave.finished.push_back(i);
    }
    trackWave(context, tree, wave, progress);
  }
}

}  // namespace lumen::convert
