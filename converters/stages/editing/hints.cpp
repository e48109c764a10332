// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/hints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/selection.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;
using formats::CenterlineTree;

/// A hint and its node in a vessel.
struct Placed {
  const SeedBranch* hint = nullptr;
  std::uint32_t node = 0;
};

/// The branch that holds most points of a hint, and of several the one whose axis and radius are
/// nearest; the node is that at the first point that it holds.
std::optional<NodePlace> findPlace(const CenterlineTree& tree, const SeedBranch& hint) {
  std::optional<NodePlace> best;
  std::size_t most = 0;
  double least = 0;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    if (tree.branches[b].kind != BranchKind::Vessel) continue;
    std::optional<NodePlace> first;
    std::size_t held = 0;
    double sum = 0;
    for (const SeedPoint& point : hint.points) {
      const auto place = placeIn(tree, b, point.position);
      if (!place) continue;
      ++held;
      sum += place->share;
      if (point.radius) sum += std::abs(std::log(*point.radius / double{tree.radius[place->node]}));
      if (!first) first = place;
    }
    if (held == 0 || held < most) continue;
    const double mean = sum / static_cast<double>(held);
    if (held == most && mean >= least) continue;
    best = first;
    most = held;
    least = mean;
  }
  // a course most of which no vessel holds is another vessel
  if (2 * most < hint.points.size()) return std::nullopt;
  return best;
}

/// The node of a vessel, from `from` to before `end`, that another vessel leaves nearest to `click`;
/// empty if there is none. A click lies behind the beginning of its vessel, so a fork behind the
/// click counts as if it were twice as far away.
std::optional<std::uint32_t> forkNear(const CenterlineTree& tree, std::uint32_t click,
                                      std::uint32_t from, std::uint32_t end) {
  std::optional<std::uint32_t> best;
  const auto away = [&](std::uint32_t at) { return at < click ? click - at : 2 * (at - click); };
  for (const formats::Branch& child : tree.branches) {
    if (child.parentNode == formats::kNoParent || child.kind != BranchKind::Vessel) continue;
    const auto at = static_cast<std::uint32_t>(child.parentNode);
    if (at >= from && at < end && (!best || away(at) < away(*best))) best = at;
  }
  return best;
}

/// From hints to the case, one kind of statement after the other.
class Hinted {
public:
  Hinted(formats::Case& target, const std::vector<SeedBranch>& hints)
      : m_case(target), m_hints(hints), m_labels(labelsOf(hints)) {}

  HintRemarks apply(std::span<const Vector3d> roots) {
    const std::vector<formats::Step> before = m_case.metadata.steps;
    makeRoots(roots);
    freeNames();
    name();
    goOn();
    for (const SeedBranch& hint : m_hints) join(hint);
    dropSacs();
    giveRest();
    m_out.holders = m_holder;
    m_case.metadata.steps = before;
    if (m_named > 0)
      recordEdit(m_case.metadata,
                 "named " + counted(m_named, "vessel", "vessels") + " as seeds state");
    return std::move(m_out);
  }

private:
  static std::set<std::string> labelsOf(const std::vector<SeedBranch>& hints) {
    std::set<std::string> labels;
    for (const SeedBranch& hint : hints) labels.insert(hint.label);
    return labels;
  }

  [[nodiscard]] const CenterlineTree& tree() const { return m_case.tree; }

  void makeRoots(std::span<const Vector3d> roots) {
    std::set<std::string> parents;
    for (const SeedBranch& hint : m_hints)
      if (hint.parent) parents.insert(*hint.parent);
    std::vector<Vector3d> places(roots.begin(), roots.end());
    std::vector<const SeedBranch*> begun;
    for (const SeedBranch& hint : m_hints)
      if (hint.isRoot || (!hint.parent && parents.contains(hint.label))) {
        places.push_back(hint.points.front().position);
        begun.push_back(&hint);
      }
    for (const UnusedPlace& unused : beginAt(m_case, places)) {
      if (unused.index < roots.size()) {
        m_out.unusedRoots.push_back(unused);
        continue;
      }
      const SeedBranch& hint = *begun[unused.index - roots.size()];
      // a hint in no vessel starts a tree of its own
      if (hint.isRoot && unused.why != UnusedPlace::Why::InNoVessel)
        m_out.unrooted.push_back({hint.label, reasonFor(unused.why)});
    }
  }

  /// Takes the hints' names from branches that have them by chance.
  void freeNames() {
    std::set<std::string> used = m_labels;
    for (const formats::Branch& branch : tree().branches) used.insert(branch.label);
    std::size_t number = 0;
    for (formats::Branch& branch : m_case.tree.branches) {
      if (!m_labels.contains(branch.label)) continue;
      do branch.label = provisionalName(++number);
      while (!used.insert(branch.label).second);
    }
  }

  /// Names vessels by their hints. Branches are divided from the last on, so that the indices of
  /// those before stay.
  void name() {
    std::map<std::uint32_t, std::vector<Placed>> hintsOf;
    for (const SeedBranch& hint : m_hints) {
      if (hint.kind != BranchKind::Vessel) continue;
      const auto place = findPlace(tree(), hint);
      if (!place)
        m_unplaced.push_back(&hint);
      else
        hintsOf[place->branch].push_back({&hint, place->node});
    }
    for (auto at = hintsOf.rbegin(); at != hintsOf.rend(); ++at) {
      std::stable_sort(at->second.begin(), at->second.end(),
                       [](const Placed& a, const Placed& b) { return a.node < b.node; });
      nameBranch(at->first, at->second);
    }
    for (const SeedBranch& hint : m_hints)
      if (m_holder.contains(hint.label)) noteMissed(hint);
  }

  void nameBranch(std::uint32_t branch, const std::vector<Placed>& hints) {
    // those that share a node with the one before have no vessel of their own
    std::vector<Placed> kept;
    for (const Placed& one : hints)
      if (!kept.empty() && kept.back().node == one.node)
        refuse(one, *kept.back().hint);
      else
        kept.push_back(one);
    for (std::size_t k = kept.size(); k-- > 1;) {
      const std::uint32_t from = kept[k - 1].node, to = kept[k].node;
      const formats::Branch& record = tree().branches[branch];
      const std::uint32_t end = record.firstNode + record.nodeCount - 1;
      const auto fork = forkNear(tree(), to, from, end);
      const std::uint32_t cut = fork ? *fork + 1 : from + (to - from + 1) / 2;
      if (!fork)
        m_out.halved.push_back(
            {kept[k].hint->label,
             quoted(kept[k - 1].hint->label) +
                 " lies in the same vessel, which no other leaves: it is divided "
                 "halfway between both, at " +
                 vectorText(toEigen(tree().centre[cut])) + " mm"});
      cutBefore(m_case, cut, Rest::Child);
      give(branch + 1, *kept[k].hint);
    }
    give(branch, *kept.front().hint);
  }

  /// Lets vessels that end where the next hint's begins go on with the widest branch there that has
  /// no hint.
  void goOn() {
    for (std::uint32_t b = 0; b < tree().branches.size(); ++b) {
      if (!m_labels.contains(tree().branches[b].label)) continue;
      const std::uint32_t last = tree().branches[b].firstNode + tree().branches[b].nodeCount - 1;
      bool hasNamed = false;
      std::uint32_t widest = b;
      for (std::uint32_t c = b + 1; c < tree().branches.size(); ++c) {
        const formats::Branch& child = tree().branches[c];
        if (child.parentNode != static_cast<std::int32_t>(last)) continue;
        const bool isNamed = m_labels.contains(child.label);
        hasNamed = hasNamed || isNamed;
        if (isNamed || child.kind != BranchKind::Vessel) continue;
        if (widest == b || medianRadius(c) > medianRadius(widest)) widest = c;
      }
      if (hasNamed && widest != b) mergeIntoParent(m_case, widest);
    }
  }

  /// The median radius of a branch, mm.
  [[nodiscard]] float medianRadius(std::uint32_t branch) const {
    const auto first = tree().radius.begin() + tree().branches[branch].firstNode;
    std::vector<float> radii(first, first + tree().branches[branch].nodeCount);
    return upperMedian(radii);
  }

  void give(std::uint32_t branch, const SeedBranch& hint) {
    m_case.tree.branches[branch].label = hint.label;
    m_holder[hint.label] = hint.label;
    ++m_named;
  }

  void refuse(const Placed& placed, const SeedBranch& holder) {
    m_holder[placed.hint->label] = holder.label;
    m_out.unused.push_back({placed.hint->label, "it lies where " + quoted(holder.label) +
                                                    " does, which names the vessel"});
  }

  void noteMissed(const SeedBranch& hint) {
    for (std::size_t i = 0; i < hint.points.size(); ++i)
      if (!placeIn(tree(), hint.points[i].position))
        m_out.missedPoints.push_back(
            {hint.label, "point " + std::to_string(i + 1) + ", which lies in no vessel"});
  }

  /// Makes a vessel hang on its stated parent, or notes why it does not.
  void join(const SeedBranch& hint) {
    if (!hint.parent || hint.kind != BranchKind::Vessel) return;
    const auto own = branchNamed(tree(), hint.label);
    const auto holder = m_holder.find(*hint.parent);
    if (!own || holder == m_holder.end()) return;
    const std::uint32_t parent = *branchNamed(tree(), holder->second);
    if (hangsOn(tree(), *own, parent)) return;
    const auto firstOf = [&](std::uint32_t b) { return tree().branches[b].firstNode; };
    if (rootAbove(tree(), firstOf(*own)) == rootAbove(tree(), firstOf(parent))) {
      m_out.unjoined.push_back(
          {hint.label,
           quoted(*hint.parent) + ", as the lumen leads to it from " + aboveText(tree(), *own)});
      return;
    }
    bridge(hint, *own, parent);
  }

  /// Joins a vessel to a parent in another tree by its nearer end, if the gap is shorter than it.
  void bridge(const SeedBranch& hint, std::uint32_t own, std::uint32_t parent) {
    const formats::Branch& record = tree().branches[own];
    const std::uint32_t first = record.firstNode, last = first + record.nodeCount - 1;
    const bool isRoot = record.parentNode == formats::kNoParent;
    const auto [toFirst, atFirst] = nearestOn(parent, first);
    const auto [toLast, atLast] = nearestOn(parent, last);
    const bool byFirst = isRoot && toFirst <= toLast;
    const double gap = byFirst ? toFirst : toLast;
    const double length = formats::branchLength(tree(), record);
    if (gap > length) {
      m_out.unjoined.push_back({hint.label, quoted(*hint.parent) + ": " + millimetres(gap) +
                                                " lie between them, and the vessel has " +
                                                millimetres(length)});
      return;
    }
    const formats::Vec3f target = tree().centre[byFirst ? atFirst : atLast];
    if (!byFirst) isRoot ? reverseBranch(m_case, own) : makeRoot(m_case, own);
    const std::uint32_t on = *branchNamed(tree(), m_holder.at(*hint.parent));
    joinBranch(m_case, *branchNamed(tree(), hint.label), nodeAt(on, target));
  }

  /// Distance from a node to the nearest one of a branch, mm, and that one.
  [[nodiscard]] std::pair<double, std::uint32_t> nearestOn(std::uint32_t branch,
                                                           std::uint32_t node) const {
    const formats::Branch& record = tree().branches[branch];
    std::pair<double, std::uint32_t> best{std::numeric_limits<double>::infinity(), 0};
    for (std::uint32_t n = record.firstNode; n < record.firstNode + record.nodeCount; ++n)
      best = std::min(best, {(toEigen(tree().centre[n]) - toEigen(tree().centre[node])).norm(), n});
    return best;
  }

  [[nodiscard]] std::uint32_t nodeAt(std::uint32_t branch, const formats::Vec3f& centre) const {
    const std::uint32_t first = tree().branches[branch].firstNode;
    const auto begin = tree().centre.begin() + first;
    return first + static_cast<std::uint32_t>(
                       std::find(begin, begin + tree().branches[branch].nodeCount, centre) - begin);
  }

  /// Deletes the aneurysms in which an aneurysm of the hints lies, as its own clicks capture it.
  void dropSacs() {
    std::vector<bool> goes(tree().branches.size(), false);
    for (std::uint32_t b = 0; b < goes.size(); ++b)
      if (tree().branches[b].kind == BranchKind::Aneurysm)
        goes[b] = std::any_of(m_hints.begin(), m_hints.end(), [&](const SeedBranch& hint) {
          return hint.kind == BranchKind::Aneurysm &&
                 std::any_of(hint.points.begin(), hint.points.end(), [&](const SeedPoint& p) {
                   return placeIn(tree(), b, p.position).has_value();
                 });
        });
    leaveOutBranches(m_case, goes);
  }

  void giveRest() {
    for (const SeedBranch& hint : m_hints) {
      const bool isUnplaced =
          std::find(m_unplaced.begin(), m_unplaced.end(), &hint) != m_unplaced.end();
      if (!isUnplaced && hint.kind == BranchKind::Vessel) continue;
      SeedBranch seed = hint;
      if (seed.parent && m_holder.contains(*seed.parent)) {
        // the lumen shows which vessel it leaves; a way from its parent may lead along others
        if (seed.kind == BranchKind::Vessel)
          seed.parent.reset();
        else
          seed.parent = m_holder.at(*seed.parent);
      }
      if (!seed.parent && seed.kind == BranchKind::Aneurysm)
        if (const auto place = placeIn(tree(), seed.points.front().position))
          seed.parent = tree().branches[place->branch].label;
      m_out.rest.push_back(std::move(seed));
    }
  }

  formats::Case& m_case;
  const std::vector<SeedBranch>& m_hints;
  std::set<std::string> m_labels;
  std::map<std::string, std::string> m_holder;  ///< label of each placed hint, label of its branch
  std::vector<const SeedBranch*> m_unplaced;
  std::size_t m_named = 0;
  HintRemarks m_out;
};

}  // namespace

HintRemarks applyHints(formats::Case& target, const std::vector<SeedBranch>& hints,
                       std::span<const Vector3d> roots) {
  return Hinted(target, hints).apply(roots);
}

}  // namespace lumen::convert
