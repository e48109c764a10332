// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_by_depth.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/stages/tracking/sac_walls.h"
#include "converters/stages/tracking/track_steps.h"

namespace lumen::convert {
namespace {

using formats::StopReason;

/// A click that states less than this share of the vessel's radius is on one of its branches.
constexpr double kOwnRadius = 0.6;
/// Nodes that a tail needs beyond the clicks of the vessel from which it is taken.
constexpr std::size_t kBeyondClicks = 2;

/// The parents that seeds name, by position in the list (-1: none), and depths below a root.
struct SeedTree {
  explicit SeedTree(const std::vector<SeedBranch>& seeds) {
    std::unordered_map<std::string, int> position;
    for (const SeedBranch& seed : seeds) {
      const int above = seed.parent ? position.at(*seed.parent) : -1;
      position[seed.label] = static_cast<int>(parent.size());
      parent.push_back(above);
      depth.push_back(above < 0 ? 0 : depth[static_cast<std::size_t>(above)] + 1);
      deepest = std::max(deepest, depth.back());
    }
  }

  std::vector<int> parent, depth;
  int deepest = 0;
};

/// The seeds of one depth, and the vessels that were tracked before them.
struct OneDepth {
  TrackedTree& tree;
  std::vector<std::size_t> members = {};   ///< in the seeds' order
  std::vector<std::size_t> finished = {};  ///< vessels with nodes
};

/// The nearest ancestor that has nodes, or the branch that one of them was tracked as part of; -1
/// if there is none.
int trackedAncestor(const SeedTree& seeds, const std::vector<TrackedBranch>& branches,
                    std::size_t seed) {
  int above = seeds.parent[seed];
  while (above >= 0) {
    const TrackedBranch& branch = branches[static_cast<std::size_t>(above)];
    if (!branch.nodes.empty()) return above;
    if (branch.trackedBy >= 0) return branch.trackedBy;
    above = seeds.parent[static_cast<std::size_t>(above)];
  }
  return -1;
}

/// The node of a vessel that a click lies at; empty if the click is not near its axis, or states
/// the radius of another vessel.
std::optional<std::size_t> nodeAtClick(const TrackedBranch& vessel, const SeedBranch& seed,
                                       const Eigen::Vector3d& click) {
  const ChainPoint at = closestOnChain(vessel.nodes, click);
  if (at.distance > kCore * at.radius) return std::nullopt;
  if (seed.points[0].radius && *seed.points[0].radius < kOwnRadius * at.radius) return std::nullopt;
  return at.node;
}

/// The last node at which one of the seed's own points lies.
std::size_t lastClickNode(const TrackedBranch& branch, const SeedBranch& seed) {
  std::size_t last = branch.clickNode;
  for (const SeedPoint& point : seed.points) {
    const ChainPoint at = closestOnChain(branch.nodes, point.position);
    if (at.distance < at.radius) last = std::max(last, at.node);
  }
  return last;
}

/// A vessel that has run on into the one that a later seed names keeps its nodes before that seed's
/// click. The later seed takes the rest, or keeps its own track from the click on if that is
/// longer. `node`: the vessel's node at the click.
void giveTail(std::vector<TrackedBranch>& branches, int from, std::size_t node,
              TrackedBranch& taker) {
  TrackedBranch& giver = branches[static_cast<std::size_t>(from)];
  const std::size_t click = std::min(taker.clickNode, taker.nodes.size());
  const auto own = std::span(taker.nodes).subspan(click);
  const auto tail = std::span(giver.nodes).subspan(node);
  if (own.size() > 1 && measureLength(own) >= measureLength(tail)) {
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

/// Gives the members of a depth the nodes that vessels of their tree have tracked beyond the
/// members' clicks.
void giveTails(const OneDepth& depth) {
  std::vector<std::size_t> givers = depth.finished;
  for (const std::size_t i : depth.members) {
    TrackedBranch& branch = depth.tree.branches[i];
    const SeedBranch& seed = depth.tree.seeds[i];
    const Eigen::Vector3d click =
        branch.nodes.empty() ? seed.points[0].position : branch.nodes[branch.clickNode].centre;
    for (const std::size_t g : givers) {
      TrackedBranch& giver = depth.tree.branches[g];
      if (giver.nodes.empty()) continue;
      const auto node = nodeAtClick(giver, seed, click);
      if (!node) continue;
      const bool isBeyond = g >= depth.tree.known &&
                            *node > lastClickNode(giver, depth.tree.seeds[g]) + kBeyondClicks;
      if (seed.parent && isBeyond && *node + 1 < giver.nodes.size())
        giveTail(depth.tree.branches, static_cast<int>(g), *node, branch);
      else if (branch.nodes.empty())
        branch.trackedBy = static_cast<int>(g);
      break;
    }
    givers.push_back(i);
  }
}

/// The first of some branches in whose core a node lies; -1 if there is none.
int findHolder(const OneDepth& depth, std::span<const std::size_t> others,
               const TrackedNode& node) {
  for (const std::size_t other : others) {
    const TrackedBranch* branch = &depth.tree.branches[other];
    if (inCore({&branch, 1}, node)) return static_cast<int>(other);
  }
  return -1;
}

/// Cuts off stretches that an earlier branch of the same depth has tracked too, on either side of
/// the click.
void trimDuplicates(const OneDepth& depth) {
  std::vector<std::size_t> kept;
  for (const std::size_t b : depth.members) {
    TrackedBranch& branch = depth.tree.branches[b];
    auto& nodes = branch.nodes;
    if (nodes.empty()) continue;
    std::vector<std::size_t> others = kept;
    if (branch.isTail) std::erase(others, static_cast<std::size_t>(branch.parentBranch));
    const auto met = [&](const TrackedNode& n) { return findHolder(depth, others, n) >= 0; };
    const auto click = nodes.begin() + static_cast<std::ptrdiff_t>(branch.clickNode);
    const auto end = std::find_if(click, nodes.end(), met);
    const auto begin = std::find_if(std::make_reverse_iterator(click), nodes.rend(), met).base();
    const auto cut = static_cast<std::size_t>(begin - nodes.begin());
    if (end != nodes.end()) branch.stopReason = StopReason::MetBranch;
    if (cut > 0) branch.startReason = StopReason::MetBranch;
    if (end == click) {
      branch.failure = kTrackedAlready;
      branch.trackedBy = findHolder(depth, others, *click);
      nodes.clear();
    } else {
      nodes.erase(end, nodes.end());
      nodes.erase(nodes.begin(), begin);
      branch.clickNode -= cut;
    }
    kept.push_back(b);
  }
}

void trackOneDepth(const TrackContext& context, const SeedTree& seeds, OneDepth& depth,
                   Progress& progress) {
  TrackedTree& tree = depth.tree;
  std::vector<const TrackedBranch*> finished;
  for (const std::size_t i : depth.finished) finished.push_back(&tree.branches[i]);
  tbb::parallel_for(std::size_t{0}, depth.members.size(), [&](std::size_t m) {
    const std::size_t i = depth.members[m];
    const SeedBranch& seed = tree.seeds[i];
    const int p = trackedAncestor(seeds, tree.branches, i);
    const TrackedBranch* parent = p < 0 ? nullptr : &tree.branches[static_cast<std::size_t>(p)];
    TrackRun run(context, Random(context.options.seed, i));
    TrackedBranch branch = tree.isVessel(i) ? trackBranch(run, seed, parent, finished)
                                            : captureAneurysm(run, seed, parent);
    branch.parentBranch = p;
    tree.branches[i] = std::move(branch);
    progress.advance();
  });
  std::erase_if(depth.members, [&](std::size_t i) { return !tree.isVessel(i); });
  giveTails(depth);
  trimDuplicates(depth);
}

}  // namespace

void trackByDepth(const TrackContext& context, TrackedTree& tree, Progress& progress) {
  const SeedTree seeds(tree.seeds);
  tree.branches.resize(tree.seeds.size());
  for (int level = 0; level <= seeds.deepest; ++level) {
    OneDepth depth{tree};
    for (std::size_t i = 0; i < tree.seeds.size(); ++i) {
      const bool isDone = i < tree.known || seeds.depth[i] < level;
      if (!isDone && seeds.depth[i] == level) depth.members.push_back(i);
      if (isDone && tree.isVessel(i) && !tree.branches[i].nodes.empty())
        depth.finished.push_back(i);
    }
    trackOneDepth(context, seeds, depth, progress);
  }
}

}  // namespace lumen::convert
