// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/measure_changes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"

namespace lumen::convert {

namespace {

using Match = std::vector<std::optional<std::uint32_t>>;

constexpr double kMatched = 0.5;       // share of a vessel's nodes that lie in the other vessel
constexpr double kSamePlaceRadii = 3;  // of two narrowings of a vessel

Measured differenceOf(const Measured& before, const Measured& after) {
  if (!after.absent.empty()) return after;
  if (!before.absent.empty()) return before;
  return {after.value - before.value, std::hypot(after.plusMinus, before.plusMinus), {}};
}

MeasureRow differenceOf(const MeasureRow& before, const MeasureRow& after) {
  MeasureRow row = after;
  for (std::size_t i = 0; i < row.values.size(); ++i)
    row.values[i] = differenceOf(before.values[i], after.values[i]);
  return row;
}

const MeasureTable& tableOf(const std::vector<MeasureTable>& tables, std::string_view kind) {
  return *std::find_if(tables.begin(), tables.end(),
                       [&](const MeasureTable& table) { return table.kind == kind; });
}

/// The columns of a table, without rows, for vessels that have a name before as well.
MeasureTable emptyLike(const MeasureTable& table, std::string_view kind) {
  MeasureTable out{kind, table.labels, table.places, table.values, {}};
  out.labels.push_back("before");
  return out;
}

void addRow(const MeasureRow& before, const MeasureRow& after, const std::string& name,
            MeasureTable& out) {
  MeasureRow row = differenceOf(before, after);
  row.labels.push_back(name);
  out.rows.push_back(std::move(row));
}

}  // namespace

Match matchBranches(const formats::Case& before, const formats::Case& after) {
  const formats::CenterlineTree& tree = after.tree;
  Match match(tree.branches.size());
  if (before.tree.nodeCount() == 0) return match;
  const TubeTreeDistance lumen(before.tree);
  struct Claim {
    std::size_t nodes;
    std::uint32_t own, other;
  };
  std::vector<Claim> claims;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    std::map<std::uint32_t, std::size_t> hits;
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
      const WallHit hit = lumen.nearest(toEigen(tree.centre[n]));
      if (hit.distance < 0) ++hits[hit.branch];
    }
    for (const auto& [other, nodes] : hits)
      if (static_cast<double>(nodes) >= kMatched * branch.nodeCount &&
          before.tree.branches[other].kind == branch.kind)
        claims.push_back({nodes, b, other});
  }
  std::stable_sort(claims.begin(), claims.end(),
                   [](const Claim& a, const Claim& b) { return a.nodes > b.nodes; });
  std::vector<bool> isTaken(before.tree.branches.size(), false);
  for (const Claim& claim : claims) {
    if (isTaken[claim.other] || match[claim.own]) continue;
    isTaken[claim.other] = true;
    match[claim.own] = claim.other;
  }
  return match;
}

std::vector<MeasureTable> measureChanges(const MeasuredCaseOf& before,
                                         const MeasuredCaseOf& after) {
  const Match match = matchBranches(before.source, after.source);
  const auto earlier = measureTables(before.source, before.measures);
  const auto later = measureTables(after.source, after.measures);
  const auto nameOf = [&](std::uint32_t b) { return before.source.tree.branches[b].label; };
  std::vector<MeasureTable> out;

  MeasureTable& vessels = out.emplace_back(emptyLike(tableOf(later, "vessels"), "vessel_changes"));
  for (std::uint32_t b = 0; b < match.size(); ++b)
    if (match[b])
      addRow(tableOf(earlier, "vessels").rows[*match[b]], tableOf(later, "vessels").rows[b],
             nameOf(*match[b]), vessels);

  MeasureTable forks = emptyLike(tableOf(later, "forks"), "fork_changes");
  const auto isMatch = [&](std::uint32_t own, std::uint32_t other) { return match[own] == other; };
  for (std::size_t i = 0; i < after.measures.forks.size(); ++i) {
    const ForkMeasures& own = after.measures.forks[i];
    for (std::size_t k = 0; k < before.measures.forks.size(); ++k) {
      const ForkMeasures& other = before.measures.forks[k];
      if (!isMatch(own.parent, other.parent) || !isMatch(own.larger, other.larger) ||
          !isMatch(own.smaller, other.smaller))
        continue;
      addRow(tableOf(earlier, "forks").rows[k], tableOf(later, "forks").rows[i],
             nameOf(other.parent), forks);
      break;
    }
  }
  out.push_back(std::move(forks));

  MeasureTable narrowings = emptyLike(tableOf(later, "narrowings"), "narrowing_changes");
  for (std::size_t i = 0; i < after.measures.narrowings.size(); ++i) {
    const NarrowingMeasures& own = after.measures.narrowings[i];
    for (std::size_t k = 0; k < before.measures.narrowings.size(); ++k) {
      const NarrowingMeasures& other = before.measures.narrowings[k];
      if (!isMatch(own.branch, other.branch) || own.isDilation != other.isDilation ||
          (own.place - other.place).norm() > 0.5 * kSamePlaceRadii * own.healthyDiameter.value)
        continue;
      addRow(tableOf(earlier, "narrowings").rows[k], tableOf(later, "narrowings").rows[i],
             nameOf(other.branch), narrowings);
      break;
    }
  }
  out.push_back(std::move(narrowings));
  return out;
}

}  // namespace lumen::convert
