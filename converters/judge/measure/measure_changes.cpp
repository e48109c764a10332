// SPDX-License-Identifier: Apache-2.0
// Declared in measure_tables.h.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/measure_tables.h"

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

/// Two cases with their tables and with the branches that match.
struct Compared {
  const formats::CenterlineTree& earlierTree;
  std::vector<MeasureTable> earlier, later;
  Match match;

  /// True if branch `own` of the later case is branch `other` of the earlier one.
  [[nodiscard]] bool isSame(std::uint32_t own, std::uint32_t other) const {
    return match[own] == other;
  }
};

/// The differences of the rows of one kind. For each row of the later case the first of the earlier
/// one counts of which `isPair` holds; `branchOf` gives the branch that names a row.
template <class Row, class IsPair, class BranchOf>
MeasureTable changesOf(const Compared& cases, std::string_view kind, std::string_view name,
                       const std::vector<Row>& before, const std::vector<Row>& after,
                       IsPair&& isPair, BranchOf&& branchOf) {
  const MeasureTable &earlier = tableOf(cases.earlier, kind), &later = tableOf(cases.later, kind);
  MeasureTable out = emptyLike(later, name);
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (!isPair(after[i], before[k])) continue;
      MeasureRow row = differenceOf(earlier.rows[k], later.rows[i]);
      row.labels.push_back(cases.earlierTree.branches[branchOf(before[k])].label);
      out.rows.push_back(std::move(row));
      break;
    }
  return out;
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
  const Compared cases{before.source.tree, measureTables(before.source, before.measures),
                       measureTables(after.source, after.measures),
                       matchBranches(before.source, after.source)};
  const CaseMeasures &earlier = before.measures, &later = after.measures;
  std::vector<MeasureTable> out;
  out.push_back(changesOf(
      cases, "vessels", "vessel_changes", earlier.vessels, later.vessels,
      [&](const VesselMeasures& own, const VesselMeasures& other) {
        return cases.isSame(own.branch, other.branch);
      },
      [](const VesselMeasures& m) { return m.branch; }));
  out.push_back(changesOf(
      cases, "paths", "path_changes", earlier.paths, later.paths,
      [&](const PathMeasures& own, const PathMeasures& other) {
        return cases.isSame(own.inlet, other.inlet) && cases.isSame(own.end, other.end);
      },
      [](const PathMeasures& m) { return m.end; }));
  out.push_back(changesOf(
      cases, "forks", "fork_changes", earlier.forks, later.forks,
      [&](const ForkMeasures& own, const ForkMeasures& other) {
        return cases.isSame(own.parent, other.parent) && cases.isSame(own.larger, other.larger) &&
               cases.isSame(own.smaller, other.smaller);
      },
      [](const ForkMeasures& m) { return m.parent; }));
  out.push_back(changesOf(
      cases, "narrowings", "narrowing_changes", earlier.narrowings, later.narrowings,
      [&](const NarrowingMeasures& own, const NarrowingMeasures& other) {
        return cases.isSame(own.branch, other.branch) && own.isDilation == other.isDilation &&
               (own.place - other.place).norm() <=
                   0.5 * kSamePlaceRadii * own.healthyDiameter.value;
      },
      [](const NarrowingMeasures& m) { return m.branch; }));
  out.push_back(changesOf(
      cases, "sacs", "sac_changes", earlier.sacs, later.sacs,
      [&](const SacMeasures& own, const SacMeasures& other) {
        return cases.isSame(own.branch, other.branch);
      },
      [](const SacMeasures& m) { return m.branch; }));
  return out;
}

}  // namespace lumen::convert
