// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/gate/gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "converters/base/vectors.h"
#include "converters/judge/facts/check_facts.h"

namespace lumen::convert {

namespace {

/// All that a verdict is made from.
struct Judged {
  const formats::Case& value;
  const CheckReport& report;
  const std::optional<Reach>& reach;
};

double valueOf(const std::string& measure, const Judged& judged) {
  const CheckReport& report = judged.report;
  const Offsets& wall = report.offsets;
  if (measure == "coverage_share")
    return share(report.shownLength, report.shownLength + report.missingLength());
  if (measure == "missing_mm") return report.missingLength();
  if (measure == "dark_share") return share(report.dark.volume, report.lumenVolume);
  if (measure == "wall_median_voxels") return wall.absoluteMedian / report.voxelSize;
  if (measure == "wall_p90_voxels") return wall.absoluteP90 / report.voxelSize;
  if (measure == "beyond_voxel_share") return wall.beyondVoxel;
  if (measure == "no_edge_share") return wall.noEdge;
  if (measure == "wrong_polarity_share") return wall.wrongPolarity;
  if (measure == "ends_stop_short") return static_cast<double>(endsThatStopShort(report).size());
  if (measure == "nodes_outside") return static_cast<double>(report.nodesOutside);
  return judged.reach ? share(judged.reach->length, judged.reach->of) : NAN;
}

/// 0 at the limit, 1 where a share that should be 1 is twice as far from it as the limit, or a
/// number is twice the limit.
double excessOf(const Threshold& threshold, double found) {
  if (std::isnan(found)) return std::numeric_limits<double>::infinity();
  const double beyond = threshold.isLeast ? threshold.limit - found : found - threshold.limit;
  const double unit = threshold.isLeast ? 1 - threshold.limit : threshold.limit;
  return beyond / std::max(unit, 1e-3);
}

/// The middle of the longest run of nodes along a branch whose wall is off.
std::optional<std::uint32_t> middleOfPoorWall(const Judged& judged) {
  const auto& tree = judged.value.tree;
  const std::vector<Agreement>& nodes = judged.report.nodes;
  std::uint32_t bestFirst = 0, bestCount = 0, count = 0;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const bool goesOn = count > 0 && tree.branch[i] == tree.branch[i - 1];
    const bool isPoor = nodes[i] == Agreement::Poor;
    count = !isPoor ? 0 : goesOn ? count + 1 : 1;
    if (count <= bestCount) continue;
    bestCount = count;
    bestFirst = i + 1 - count;
  }
  if (bestCount == 0) return {};
  return bestFirst + bestCount / 2;
}

std::optional<GatePlace> placeOf(const std::string& measure, const Judged& judged) {
  const CheckReport& report = judged.report;
  const auto& tree = judged.value.tree;
  if (measure == "coverage_share" || measure == "missing_mm") {
    if (report.missing.vessels.empty()) return {};
    const MissingVessel& vessel = report.missing.vessels.front();
    return GatePlace{measure, middleOf(vessel), vessel.path.front().node};
  }
  if (measure == "dark_share") {
    if (report.dark.regions.empty()) return {};
    return GatePlace{measure, report.dark.regions.front().position,
                     report.dark.regions.front().node};
  }
  if (measure == "ends_stop_short") {
    const std::uint32_t node = endsThatStopShort(report).front().node;
    return GatePlace{measure, toEigen(tree.centre[node]), node};
  }
  if (measure == "nodes_outside") return {};
  if (measure == "reachable_share") {
    if (!judged.reach || judged.reach->closed.empty()) return {};
    const std::uint32_t node = judged.reach->closed.front().node;
    return GatePlace{measure, toEigen(tree.centre[node]), node};
  }
  const auto node = middleOfPoorWall(judged);
  if (!node) return {};
  return GatePlace{measure, toEigen(tree.centre[*node]), *node};
}

}  // namespace

GateVerdict judgeCase(const GateProfile& profile, const formats::Case& value,
                      const CheckReport& report, const std::optional<Reach>& reach) {
  const Judged judged{value, report, reach};
  GateVerdict verdict{profile.name, {}, {}};
  for (const Threshold& threshold : profile.thresholds) {
    const double found = valueOf(threshold.measure, judged);
    const double excess = excessOf(threshold, found);
    if (excess > 0) verdict.faults.push_back({threshold, found, excess});
  }
  std::stable_sort(verdict.faults.begin(), verdict.faults.end(),
                   [](const GateFault& a, const GateFault& b) { return a.excess > b.excess; });
  for (const GateFault& fault : verdict.faults)
    if (!verdict.worst) verdict.worst = placeOf(fault.threshold.measure, judged);
  return verdict;
}

}  // namespace lumen::convert
