// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/gate/gate_profile.h"

#include <algorithm>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/suggestion.h"
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

}  // namespace lumen::convert
