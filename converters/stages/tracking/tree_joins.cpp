// SPDX-License-Identifier: Apache-2.0
// Declared in track_by_depth.h.
#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/stages/tracking/joining.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/track_by_depth.h"

namespace lumen::convert {
namespace {

using formats::StopReason;

/// Largest radius of a root that may be joined by its tip, in radii of the other vessel.
constexpr double kNoWiderRadii = 1.2;

/// Uses of random numbers; each has a stream of its own for every branch.
enum class Use : std::size_t { Extension = 1, Gaps, Join };

/// The vessels that have nodes, in the seeds' order, and work on those that are new.
class Vessels {
public:
  Vessels(const TrackContext& context, TrackedTree& tree) : m_context(context), m_tree(tree) {
    for (std::size_t i = 0; i < tree.seeds.size(); ++i) {
      if (!tree.isVessel(i) || tree.branches[i].nodes.empty()) continue;
      m_members.push_back(i);
      if (i >= tree.known) m_new.push_back(i);
    }
  }
  [[nodiscard]] const std::vector<std::size_t>& members() const { return m_members; }
  [[nodiscard]] const std::vector<std::size_t>& newMembers() const { return m_new; }
  [[nodiscard]] const std::vector<TrackedBranch>& branches() const { return m_tree.branches; }
  [[nodiscard]] TrackedBranch& operator[](std::size_t i) const { return m_tree.branches[i]; }

  using Action = std::function<void(std::size_t, TrackRun&)>;
  void forEach(Use use, std::span<const std::size_t> members, const Action& action) const {
    tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t m) {
      const std::size_t stream = static_cast<std::size_t>(use) * branches().size() + members[m];
      TrackRun run(m_context, Random(m_context.options.seed, stream));
      action(members[m], run);
    });
  }
  [[nodiscard]] std::size_t findRoot(std::size_t i) const {
    while (m_tree.branches[i].parentBranch >= 0)
      i = static_cast<std::size_t>(m_tree.branches[i].parentBranch);
    return i;
  }
  /// Links to the root, without those from a tail to the vessel it was taken from.
  [[nodiscard]] int levelOf(std::size_t i) const {
    int level = 0;
    for (; m_tree.branches[i].parentBranch >= 0;
         i = static_cast<std::size_t>(m_tree.branches[i].parentBranch))
      level += m_tree.branches[i].isTail ? 0 : 1;
    return level;
  }
  [[nodiscard]] bool hasTail(std::size_t i) const {
    return std::any_of(m_members.begin(), m_members.end(), [&](std::size_t m) {
      return m_tree.branches[m].isTail && m_tree.branches[m].parentBranch == static_cast<int>(i);
    });
  }

private:
  const TrackContext& m_context;
  TrackedTree& m_tree;
  std::vector<std::size_t> m_members, m_new;
};

/// The centerlines of all vessels as they were, without wall points.
struct Snapshot {
  explicit Snapshot(const Vessels& vessels, const VolumeGeometry& geometry) {
    for (const std::size_t i : vessels.members()) {
      TrackedBranch line;
      for (const TrackedNode& node : vessels[i].nodes) {
        TrackedNode bare;
        bare.centre = node.centre;
        bare.direction = node.direction;
        bare.radius = node.radius;
        line.nodes.push_back(std::move(bare));
      }
      lines.push_back(std::move(line));
      balls.emplace_back();
      addLumen(lines.back().nodes, geometry, balls.back());
    }
  }
  std::vector<TrackedBranch> lines;
  std::vector<std::vector<WorldBall>> balls;
};

/// Cuts off stretches into which an earlier vessel has grown too. `before`: node counts until then.
void trimExtensions(const Vessels& vessels, const std::vector<std::size_t>& before) {
  std::vector<const TrackedBranch*> grown;
  for (std::size_t m = 0; m < before.size(); ++m) {
    TrackedBranch& branch = vessels[vessels.newMembers()[m]];
    if (branch.nodes.size() <= before[m]) continue;
    const auto first = branch.nodes.begin() + static_cast<std::ptrdiff_t>(before[m]);
    const auto met = std::find_if(first, branch.nodes.end(),
                                  [&](const TrackedNode& n) { return inCore(grown, n); });
    if (met != branch.nodes.end()) {
      branch.nodes.erase(met, branch.nodes.end());
      branch.stopReason = StopReason::MetBranch;
    }
    grown.push_back(&branch);
  }
}

/// Extends the tips of all vessels that may be extended.
void extendTipsIf(const TrackContext& context, const Vessels& vessels,
                  const std::function<bool(const TrackedBranch&)>& may) {
  const Snapshot snapshot(vessels, context.volume.geometry());
  const auto& members = vessels.members();
  std::vector<std::size_t> before;
  for (const std::size_t i : vessels.newMembers()) before.push_back(vessels[i].nodes.size());
  vessels.forEach(Use::Extension, vessels.newMembers(), [&](std::size_t i, TrackRun& run) {
    if (!may(vessels[i])) return;
    std::vector<const TrackedBranch*> finished;
    std::vector<WorldBall> others;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m] == i) continue;
      finished.push_back(&snapshot.lines[m]);
      others.insert(others.end(), snapshot.balls[m].begin(), snapshot.balls[m].end());
    }
    extendTip(run, vessels[i], others, finished);
  });
  trimExtensions(vessels, before);
}

/// The vessel of another tree that an end of a root has met, or that it stopped before and points
/// to; -1 if there is none. `end` points outward.
int metAt(const Vessels& vessels, std::size_t root, const TrackedNode& end, StopReason reason) {
  if (reason == StopReason::Unknown || reason == StopReason::LeftVolume) return -1;
  int best = -1;
  double nearest = kEndRadii;
  for (const std::size_t i : vessels.members()) {
    if (vessels.findRoot(i) == root) continue;
    const ChainPoint at = closestOnChain(vessels[i].nodes, end.centre);
    if (at.distance >= nearest * at.radius) continue;
    const double ahead = (at.position - end.centre).dot(end.direction);
    if (reason != StopReason::MetBranch && ahead < kAheadCosine * at.distance) continue;
    nearest = at.distance / at.radius;
    best = static_cast<int>(i);
  }
  return best;
}

/// Joins roots that ran into another tree, or up to its wall, to it; by the tip only if the root is
/// not wider there, as a wide vessel does not come out of a narrow one.
void tieRoots(const Vessels& vessels) {
  for (const std::size_t i : vessels.newMembers()) {
    TrackedBranch& branch = vessels[i];
    if (branch.parentBranch >= 0) continue;
    int met = metAt(vessels, i, reversed(branch.nodes.front()), branch.startReason);
    if (met < 0 && !vessels.hasTail(i)) {
      const TrackedNode& tip = branch.nodes.back();
      met = metAt(vessels, i, tip, branch.stopReason);
      if (met < 0) continue;
      const auto& other = vessels[static_cast<std::size_t>(met)];
      if (tip.radius > kNoWiderRadii * closestOnChain(other.nodes, tip.centre).radius) continue;
      turnRound(branch);
    }
    branch.parentBranch = met;
  }
}

/// The path through the lumen from the first node of a new root to another tree.
std::optional<PathToBranch> pathToOtherTree(const TrackContext& context, const Vessels& vessels,
                                            std::size_t root) {
  std::vector<int> others;
  for (const std::size_t i : vessels.members())
    if (vessels.findRoot(i) != root) others.push_back(static_cast<int>(i));
  return pathToOther(context, vessels.branches(), others, vessels[root]);
}

/// Joins new roots to known trees to which the lumen leads from one of their ends: a vessel that is
/// added to a case need not name its parent.
void tieToKnown(const TrackContext& context, const Vessels& vessels) {
  for (const std::size_t i : vessels.newMembers()) {
    TrackedBranch& branch = vessels[i];
    if (branch.parentBranch >= 0) continue;
    auto path = pathToOtherTree(context, vessels, i);
    if (!vessels.hasTail(i)) {
      turnRound(branch);
      const auto other = pathToOtherTree(context, vessels, i);
      if (other && (!path || other->outside < path->outside))
        path = other;
      else
        turnRound(branch);
    }
    if (path) branch.parentBranch = path->branch;
  }
}

/// Sets the parents' nodes of tails. The vessels from which they were taken are joined by now, and
/// may have been extended.
void placeTails(const Vessels& vessels) {
  for (const std::size_t i : vessels.newMembers()) {
    TrackedBranch& branch = vessels[i];
    if (!branch.isTail) continue;
    const auto& parent = vessels[static_cast<std::size_t>(branch.parentBranch)];
    const ChainPoint at = closestOnChain(parent.nodes, branch.nodes.front().centre);
    branch.parentNode = static_cast<int>(at.node);
  }
}

/// Joins the vessels of one level to their parents. `levels`: those of all branches before any was
/// joined, as a child that cannot be joined becomes a root.
void joinLevel(const Vessels& vessels, const std::vector<int>& levels, int level) {
  std::vector<std::size_t> due;
  for (const std::size_t i : vessels.newMembers())
    if (!vessels[i].isTail && levels[i] == level) due.push_back(i);
  std::vector<std::vector<int>> others(vessels.branches().size());
  for (const std::size_t i : due)
    for (const std::size_t other : vessels.members())
      if (levels[other] < level && vessels.findRoot(other) == vessels.findRoot(i))
        others[i].push_back(static_cast<int>(other));
  vessels.forEach(Use::Join, due, [&](std::size_t i, TrackRun& run) {
    joinToParent(run, vessels.branches(), others[i], vessels[i]);
  });
}

bool isTrackedBothWays(const TrackedBranch& branch) {
  return branch.parentBranch < 0 && branch.startReason != StopReason::Unknown;
}

}  // namespace

void trimTips(const TrackContext& context, TrackedTree& tree) {
  const Vessels vessels(context, tree);
  for (const std::size_t i : vessels.newMembers()) {
    dropDome(vessels[i]);
    if (isTrackedBothWays(vessels[i])) {
      turnRound(vessels[i]);
      dropDome(vessels[i]);
      turnRound(vessels[i]);
    }
    dropTurnedBack(vessels[i]);
    dropCrowded(vessels[i]);
  }
}

void extendTips(const TrackContext& context, TrackedTree& tree) {
  const Vessels vessels(context, tree);
  extendTipsIf(context, vessels, [](const TrackedBranch&) { return true; });
  for (const std::size_t i : vessels.newMembers()) {
    dropDome(vessels[i]);
    if (isTrackedBothWays(vessels[i])) turnRound(vessels[i]);
  }
  extendTipsIf(context, vessels, isTrackedBothWays);
  for (const std::size_t i : vessels.newMembers()) {
    if (isTrackedBothWays(vessels[i])) {
      dropDome(vessels[i]);
      turnRound(vessels[i]);
    }
    dropTurnedBack(vessels[i]);
  }
}

void joinTree(const TrackContext& context, TrackedTree& tree) {
  const Vessels vessels(context, tree);
  vessels.forEach(Use::Gaps, vessels.newMembers(),
                  [&](std::size_t i, TrackRun& run) { fillGaps(run, vessels[i]); });
  tieRoots(vessels);
  if (tree.known > 0) tieToKnown(context, vessels);
  std::vector<int> levels(tree.branches.size(), 0);
  for (const std::size_t i : vessels.members()) levels[i] = vessels.levelOf(i);
  placeTails(vessels);
  const int deepest = *std::max_element(levels.begin(), levels.end());
  for (int level = 1; level <= deepest; ++level) {
    joinLevel(vessels, levels, level);
    placeTails(vessels);
  }
  for (std::size_t i = tree.known; i < tree.seeds.size(); ++i) {
    TrackedBranch& branch = tree.branches[i];
    if (tree.isVessel(i) || branch.nodes.empty() || branch.parentBranch < 0) continue;
    const auto& parent = tree.branches[static_cast<std::size_t>(branch.parentBranch)];
    branch.parentNode = static_cast<int>(closestOnChain(parent.nodes, branch.nodes[0].centre).node);
  }
}

}  // namespace lumen::convert
