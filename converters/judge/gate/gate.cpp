// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/gate/gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/judge/facts/check_facts.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

// Half a voxel is what the check calls a good wall, one voxel a fair one (check.h, Agreement).
// Shares are lumen's own choice: a tenth of the visible vessels may lack in a case to practise on,
// a twentieth in one to compute flow in, whose walls must lie within a voxel nearly everywhere.
const std::vector<GateProfile> kProfiles = {{"screening",
                                             "to look at, and to measure the main vessels",
                                             {{"coverage_share", true, 0.8},
                                              {"dark_share", false, 0.05},
                                              {"wall_median_voxels", false, 1},
                                              {"no_edge_share", false, 0.4},
                                              {"reachable_share", true, 0.8}}},
                                            {"simulator",
                                             "to push a guidewire or a catheter through",
                                             {{"coverage_share", true, 0.9},
                                              {"dark_share", false, 0.02},
                                              {"wall_median_voxels", false, 0.5},
                                              {"wall_p90_voxels", false, 1.5},
                                              {"no_edge_share", false, 0.3},
                                              {"reachable_share", true, 0.95}}},
                                            {"flow",
                                             "to compute blood flow in",
                                             {{"coverage_share", true, 0.95},
                                              {"dark_share", false, 0.01},
                                              {"wall_median_voxels", false, 0.5},
                                              {"wall_p90_voxels", false, 1},
                                              {"no_edge_share", false, 0.2},
                                              {"wrong_polarity_share", false, 0.05},
                                              {"reachable_share", true, 0.99}}}};

constexpr std::size_t kLongestName = 100;

void takeThresholds(const JsonPlace& json, const char* key, bool isLeast, GateProfile& profile) {
  if (!json.has(key)) return;
  const JsonPlace limits = json.at(key);
  for (const GateMeasure& measure : gateMeasures()) {
    const std::string name(measure.name);
    if (!limits.has(name.c_str())) continue;
    if (measure.isLeast != isLeast)
      limits.at(name).refuse(std::string("it below \"") + (isLeast ? "most" : "least") + "\"");
    const double limit = limits.at(name).number();
    if (limit < 0) limits.at(name).refuse("a number from 0");
    profile.thresholds.push_back({name, isLeast, limit});
  }
}

std::string measureNames() {
  std::string names;
  for (const GateMeasure& measure : gateMeasures())
    names.append(names.empty() ? "" : ", ").append(measure.name);
  return names;
}

/// The number of members of an object.
std::size_t memberCount(const JsonPlace& json, const char* key) {
  return json.has(key) ? json.at(key).value().members().size() : 0;
}

GateProfile profileOf(const std::string& file) {
  JsonFile text(readWholeFile(file, "profile", kMostText), file);
  const JsonPlace json(text);
  json.onlyKeys({"name", "least", "most"});
  GateProfile profile{json.at("name").text(), {}, {}};
  if (profile.name.empty() || profile.name.size() > kLongestName)
    json.at("name").refuse("a text of 1 to 100 bytes");
  takeThresholds(json, "least", true, profile);
  takeThresholds(json, "most", false, profile);
  if (profile.thresholds.size() != memberCount(json, "least") + memberCount(json, "most"))
    json.refuse("thresholds of " + measureNames());
  if (profile.thresholds.empty()) json.refuse("a threshold below \"least\" or \"most\"");
  return profile;
}

}  // namespace

const std::vector<GateMeasure>& gateMeasures() {
  static const std::vector<GateMeasure> measures = {
      {"coverage_share", true, "share of the visible vessels that the case has"},
      {"missing_mm", false, "length of visible vessels that the case lacks, mm"},
      {"dark_share", false, "share of the lumen that is dark"},
      {"wall_median_voxels", false, "median offset of the wall, voxels"},
      {"wall_p90_voxels", false, "90th percentile of the offset of the wall, voxels"},
      {"beyond_voxel_share", false, "share of the wall that is over a voxel off"},
      {"no_edge_share", false, "share of the wall without an edge"},
      {"wrong_polarity_share", false, "share of the wall that is brighter outside"},
      {"ends_stop_short", false, "number of ends that stop short"},
      {"nodes_outside", false, "number of nodes outside of the volume"},
      {"reachable_share", true, "share of the length that a tool reaches"}};
  return measures;
}

const std::vector<GateProfile>& gateProfiles() {
  return kProfiles;
}

GateProfile gateProfile(const std::string& nameOrFile) {
  if (nameOrFile.ends_with(".json")) return profileOf(nameOrFile);
  std::vector<std::string> names;
  for (const GateProfile& profile : gateProfiles()) {
    if (profile.name == nameOrFile) return profile;
    names.push_back(profile.name);
  }
  throw Error(ErrorKind::Usage, "there is no profile " + formats::printable(nameOrFile) +
                                    "; expected " + alternatives(names) +
                                    ", or a file that ends in .json" +
                                    didYouMean(nameOrFile, names));
}

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
