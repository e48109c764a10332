// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/tree_joins.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/stages/tracking/joining.h"
#include "converters/stages/tracking/onward.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

/// Radii of the other vessel within which an end that met it is.
constexpr double kAtEnd = 1.5;
/// Cosine of 45 degrees: an end looks at what lies nearer to its direction.
constexpr double kAhead = 0.7;
/// Of the other's radius: the most of a root's, whose tip may be where it hangs.
constexpr double kNoWider = 1.2;

/// What random numbers are for; each use of them has a stream of its own for every branch.
enum class Use : std::size_t { Onward = 1, Gaps, Join };

/// The vessels that have nodes, in the seeds' order, and work on those that are new.
class Vessels {
public:
  Vessels(const TrackContext& context, const std::vector<SeedBranch>& seeds, std::size_t known,
          std::vector<TrackedBranch>& branches)
      : m_context(context), m_branches(branches) {
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (seeds[i].kind != BranchKind::Vessel || branches[i].nodes.empty()) continue;
      m_members.push_back(i);
      if (i >= known) m_new.push_back(i);
    }
  }
  [[nodiscard]] const std::vector<std::size_t>& members() const { return m_members; }
  [[nodiscard]] const std::vector<std::size_t>& newMembers() const { return m_new; }
  [[nodiscard]] TrackedBranch& operator[](std::size_t i) const { return m_branches[i]; }

  using Action = std::function<void(std::size_t, Random&, TrackWorkspace&)>;
  void forEach(Use use, std::span<const std::size_t> members, const Action& action) const {
    tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t m) {
      TrackWorkspace workspace(m_context);
      const std::size_t stream = static_cast<std::size_t>(use) * m_branches.size() + members[m];
      Random random(m_context.options.seed, stream);
      action(members[m], random, workspace);
    });
  }
  [[nodiscard]] std::size_t rootOf(std::size_t i) const {
    while (m_branches[i].parentBranch >= 0)
      i = static_cast<std::size_t>(m_branches[i].parentBranch);
    return i;
  }
  /// Links to the root, without those from a tail to what it was taken from.
  [[nodiscard]] int levelOf(std::size_t i) const {
    int level = 0;
    for (; m_branches[i].parentBranch >= 0;
         i = static_cast<std::size_t>(m_branches[i].parentBranch))
      level += m_branches[i].isTail ? 0 : 1;
    return level;
  }
  [[nodiscard]] bool hasTail(std::size_t i) const {
    return std::any_of(m_members.begin(), m_members.end(), [&](std::size_t m) {
      return m_branches[m].isTail && m_branches[m].parentBranch == static_cast<int>(i);
    });
  }

private:
  const TrackContext& m_context;
  std::vector<TrackedBranch>& m_branches;
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
      addBalls(lines.back().nodes, geometry, balls.back());
    }
  }
  std::vector<TrackedBranch> lines;
  std::vector<std::vector<Ball>> balls;
};

/// Cuts off what an earlier vessel has grown into too. `before`: node counts until then.
void trimGrowth(const Vessels& vessels, const std::vector<std::size_t>& before) {
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

/// Leads on from the tips of all vessels that may.
void growTips(const TrackContext& context, const Vessels& vessels,
              const std::function<bool(const TrackedBranch&)>& may) {
  const Snapshot snapshot(vessels, context.volume.geometry());
  const auto& members = vessels.members();
  std::vector<std::size_t> before;
  for (const std::size_t i : vessels.newMembers()) before.push_back(vessels[i].nodes.size());
  vessels.forEach(
      Use::Onward, vessels.newMembers(), [&](std::size_t i, Random& random, TrackWorkspace& space) {
        if (!may(vessels[i])) return;
        std::vector<const TrackedBranch*> finished;
        std::vector<Ball> others;
        for (std::size_t m = 0; m < members.size(); ++m) {
          if (members[m] == i) continue;
          finished.push_back(&snapshot.lines[m]);
          others.insert(others.end(), snapshot.balls[m].begin(), snapshot.balls[m].end());
        }
        goOnward(context, vessels[i], others, finished, random, space);
      });
  trimGrowth(vessels, before);
}

/// The vessel of another tree that an end of a root has met, or that it stopped before and looks at;
/// -1 if there is none. `end` looks outward.
int metAt(const Vessels& vessels, std::size_t root, const TrackedNode& end, StopReason reason) {
  if (reason == StopReason::Unknown || reason == StopReason::LeftVolume) return -1;
  int best = -1;
  double nearest = kAtEnd;
  for (const std::size_t i : vessels.members()) {
    if (vessels.rootOf(i) == root) continue;
    const ChainPoint at = closestOnChain(vessels[i].nodes, end.centre);
    if (at.distance >= nearest * at.radius) continue;
    const double ahead = (at.position - end.centre).dot(end.direction);
    if (reason != StopReason::MetBranch && ahead < kAhead * at.distance) continue;
    nearest = at.distance / at.radius;
    best = static_cast<int>(i);
  }
  return best;
}

/// A root that ran into another tree, or up to its wall, hangs on it; by its tip only if it is not wider there, as a
/// wide vessel does not come out of a narrow one.
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
      if (tip.radius > kNoWider * closestOnChain(other.nodes, tip.centre).radius) continue;
      turnRound(branch);
    }
    branch.parentBranch = met;
  }
}

/// Whether the lumen leads from the first node of a new root to another tree.
std::optional<LumenWay> wayOf(const TrackContext& context, const Vessels& vessels,
                              const std::vector<TrackedBranch>& branches, std::size_t root) {
  std::vector<int> others;
  for (const std::size_t i : vessels.members())
    if (vessels.rootOf(i) != root) others.push_back(static_cast<int>(i));
  return wayToOther(context, branches, others, vessels[root]);
}

/// Ties new roots to the known trees that the lumen leads to from one of their ends: who adds a vessel to
/// a case need not say what it hangs on.
void tieToKnown(const TrackContext& context, const Vessels& vessels,
                const std::vector<TrackedBranch>& branches) {
  for (const std::size_t i : vessels.newMembers()) {
    TrackedBranch& branch = vessels[i];
    if (branch.parentBranch >= 0) continue;
    auto way = wayOf(context, vessels, branches, i);
    if (!vessels.hasTail(i)) {
      turnRound(branch);
      const auto other = wayOf(context, vessels, branches, i);
      if (other && (!way || other->outside < way->outside))
        way = other;
      else
        turnRound(branch);
    }
    if (way) branch.parentBranch = way->branch;
  }
}

/// Where tails hang on what they were taken from, which is joined by now, and may have gone on.
void placeTails(const Vessels& vessels) {
  for (const std::size_t i : vessels.newMembers()) {
    TrackedBranch& branch = vessels[i];
    if (!branch.isTail) continue;
    const auto& parent = vessels[static_cast<std::size_t>(branch.parentBranch)];
    const ChainPoint at = closestOnChain(parent.nodes, branch.nodes.front().centre);
    branch.parentNode = static_cast<int>(at.node);
  }
}

/// `levels`: of all branches, before any was joined: a child that cannot be joined becomes a root.
void joinLevel(const TrackContext& context, const Vessels& vessels,
               const std::vector<TrackedBranch>& branches, const std::vector<int>& levels,
               int level) {
  std::vector<std::size_t> due;
  for (const std::size_t i : vessels.newMembers())
    if (!vessels[i].isTail && levels[i] == level) due.push_back(i);
  std::vector<std::vector<int>> others(branches.size());
  for (const std::size_t i : due)
    for (const std::size_t other : vessels.members())
      if (levels[other] < level && vessels.rootOf(other) == vessels.rootOf(i))
        others[i].push_back(static_cast<int>(other));
  vessels.forEach(Use::Join, due, [&](std::size_t i, Random& random, TrackWorkspace& space) {
    joinToParent(context, branches, others[i], vessels[i], random, space);
  });
}

}  // namespace

void goOnwardAll(const TrackContext& context, const std::vector<SeedBranch>& seeds,
                 std::size_t known, std::vector<TrackedBranch>& branches) {
  const Vessels vessels(context, seeds, known, branches);
  growTips(context, vessels, [](const TrackedBranch&) { return true; });
  const auto isBothWays = [](const TrackedBranch& branch) {
    return branch.parentBranch < 0 && branch.startReason != StopReason::Unknown;
  };
  for (const std::size_t i : vessels.newMembers())
    if (isBothWays(vessels[i])) turnRound(vessels[i]);
  growTips(context, vessels, isBothWays);
  for (const std::size_t i : vessels.newMembers())
    if (isBothWays(vessels[i])) turnRound(vessels[i]);
}

void joinAll(const TrackContext& context, const std::vector<SeedBranch>& seeds, std::size_t known,
             std::vector<TrackedBranch>& branches) {
  const Vessels vessels(context, seeds, known, branches);
  vessels.forEach(Use::Gaps, vessels.newMembers(),
                  [&](std::size_t i, Random& random, TrackWorkspace& space) {
                    fillGaps(context, branches[i], random, space);
                  });
  tieRoots(vessels);
  if (known > 0) tieToKnown(context, vessels, branches);
  std::vector<int> levels(branches.size(), 0);
  for (const std::size_t i : vessels.members()) levels[i] = vessels.levelOf(i);
  placeTails(vessels);
  const int deepest = *std::max_element(levels.begin(), levels.end());
  for (int level = 1; level <= deepest; ++level) {
    joinLevel(context, vessels, branches, levels, level);
    placeTails(vessels);
  }
  for (std::size_t i = known; i < seeds.size(); ++i) {
    TrackedBranch& branch = branches[i];
    if (seeds[i].kind == BranchKind::Vessel || branch.nodes.empty() || branch.parentBranch < 0)
      continue;
    const auto& parent = branches[static_cast<std::size_t>(branch.parentBranch)];
    branch.parentNode = static_cast<int>(closestOnChain(parent.nodes, branch.nodes[0].centre).node);
  }
}

}  // namespace lumen::convert
