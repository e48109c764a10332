// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/check_report.h"

#include <algorithm>
#include <cmath>

#include "converters/base/text.h"
#include "converters/base/vectors.h"

namespace lumen::app {

const std::string& labelOf(const formats::CenterlineTree& tree, std::uint32_t node) {
  return tree.branches[tree.branch[node]].label;
}

const Eigen::Vector3d& middleOf(const convert::MissingVessel& vessel) {
  return vessel.way[vessel.way.size() / 2].position;
}

double share(double part, double whole) {
  return whole > 0 ? part / whole : NAN;
}

std::string percentText(double share) {
  return std::isfinite(share) ? fixed(100 * share, 1) + " %" : "-";
}

std::string placeText(const Eigen::Vector3d& p) {
  return std::string("(") + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
}

std::vector<convert::OpenEnd> endsThatStopShort(const convert::CheckReport& report) {
  std::vector<convert::OpenEnd> onward;
  for (const convert::OpenEnd& end : report.ends)
    if (end.goesOn > 0) onward.push_back(end);
  std::stable_sort(onward.begin(), onward.end(),
                   [](const auto& a, const auto& b) { return a.goesOn > b.goesOn; });
  return onward;
}

std::string SourceRelation::word() const {
  if (!isKnown) return "unknown";
  return difference ? "other " + difference->what : "same";
}

std::optional<std::string> SourceRelation::warning(const std::string& volumeName) const {
  if (!difference) return std::nullopt;
  return "was made from another volume: " +
         (difference->what == "voxels"
              ? volumeName + " has its size and place, but other voxels"
              : "its " + difference->what + " was " + difference->expected + ", that of " +
                    volumeName + " is " + difference->found);
}

SourceRelation sourceRelation(const formats::SourceVolume& volume,
                              const formats::Metadata& metadata) {
  if (!metadata.source) return {};
  return {true, convert::sourceDifference(volume, *metadata.source)};
}

std::optional<std::string> outsideWarning(const convert::CheckReport& report,
                                          const std::string& volumeName) {
  if (report.nodesOutside == 0) return std::nullopt;
  return std::to_string(report.nodesOutside) + " of its " +
         counted(report.nodes.size(), "node lies", "nodes lie") + " outside of " + volumeName;
}

namespace {

Json offsetsJson(const convert::Offsets& o, double voxel) {
  Json json;
  json["samples"] = o.samples;
  json["beside_others"] = o.beside;
  json["outside_volume"] = o.outside;
  for (const auto& [unit, size] : {std::pair{"offset_mm", 1.0}, std::pair{"offset_voxels", voxel}})
    json[unit] = {{"median", jsonNumber(o.median / size)},
                  {"median_absolute", jsonNumber(o.absoluteMedian / size)},
                  {"p90_absolute", jsonNumber(o.absoluteP90 / size)},
                  {"median_uncorrected", jsonNumber(o.uncorrectedMedian / size)},
                  {"median_steepest", jsonNumber(o.steepestMedian / size)}};
  json["beyond_voxel_share"] = jsonNumber(o.beyondVoxel);
  json["no_edge_share"] = jsonNumber(o.noEdge);
  json["wrong_polarity_share"] = jsonNumber(o.wrongPolarity);
  return json;
}

Json vectorJson(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

Json regionsJson(const convert::Regions& regions, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::Region& region : regions.regions)
    json.push_back({{"position", vectorJson(region.position)},
                    {"radius_mm", jsonNumber(region.radius)},
                    {"volume_mm3", jsonNumber(region.volume)},
                    {"voxels", region.voxels},
                    {"branch", labelOf(tree, region.node)},
                    {"node", region.node}});
  return json;
}

Json vesselsJson(const convert::Missing& missing, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::MissingVessel& vessel : missing.vessels)
    json.push_back({{"position", vectorJson(middleOf(vessel))},
                    {"start", vectorJson(vessel.way.front().position)},
                    {"tip", vectorJson(vessel.way.back().position)},
                    {"length_mm", jsonNumber(vessel.length)},
                    {"radius_mm", jsonNumber(vessel.radius)},
                    {"volume_mm3", jsonNumber(vessel.volume)},
                    {"voxels", vessel.voxels},
                    {"branch", labelOf(tree, vessel.way.front().node)},
                    {"node", vessel.way.front().node},
                    {"at_end", vessel.atEnd}});
  return json;
}

Json endsJson(const std::vector<convert::OpenEnd>& ends, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::OpenEnd& end : ends)
    json.push_back({{"position", vectorJson(toEigen(tree.centre[end.node]))},
                    {"branch", labelOf(tree, end.node)},
                    {"node", end.node},
                    {"first", end.first},
                    {"goes_on_mm", jsonNumber(end.goesOn)}});
  return json;
}

}  // namespace

Json checkJson(const convert::CheckReport& report, const formats::CenterlineTree& tree,
               const std::string& source) {
  Json json;
  json["source"] = source;
  json["voxel_size_mm"] = jsonNumber(report.voxelSize);
  json["point_spread_mm"] = jsonNumber(report.options.pointSpread);
  json["nodes_outside"] = report.nodesOutside;
  json["wall"] = offsetsJson(report.offsets, report.voxelSize);
  json["lumen_mm3"] = jsonNumber(report.lumenVolume);
  json["dark_share"] = jsonNumber(share(report.dark.volume, report.lumenVolume));
  json["dark_places"] = regionsJson(report.dark, tree);
  json["missing_share"] =
      jsonNumber(share(report.missing.volume, report.missing.volume + report.lumenVolume));
  json["missing_vessels"] = vesselsJson(report.missing, tree);
  json["wide_regions"] = regionsJson(report.missing.wide, tree);
  json["ends"] = endsJson(report.ends, tree);
  json["shown_mm"] = jsonNumber(report.shownLength);
  json["missing_mm"] = jsonNumber(report.missingLength());
  json["coverage_share"] =
      jsonNumber(share(report.shownLength, report.shownLength + report.missingLength()));
  json["branches"] = Json::array();
  for (const auto& branch : report.branches) {
    Json entry;
    entry["label"] = branch.label;
    entry["wall"] = offsetsJson(branch.offsets, report.voxelSize);
    json["branches"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace lumen::app
