// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/check_answer.h"

#include <algorithm>
#include <cmath>

#include "converters/base/text.h"
#include "converters/base/vectors.h"

namespace lumen::engine {

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
                    {"branch", convert::labelOf(tree, region.node)},
                    {"node", region.node}});
  return json;
}

Json vesselsJson(const convert::Missing& missing, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::MissingVessel& vessel : missing.vessels)
    json.push_back({{"position", vectorJson(convert::middleOf(vessel))},
                    {"start", vectorJson(vessel.path.front().position)},
                    {"tip", vectorJson(vessel.path.back().position)},
                    {"length_mm", jsonNumber(vessel.length)},
                    {"radius_mm", jsonNumber(vessel.radius)},
                    {"volume_mm3", jsonNumber(vessel.volume)},
                    {"voxels", vessel.voxels},
                    {"branch", convert::labelOf(tree, vessel.path.front().node)},
                    {"node", vessel.path.front().node},
                    {"at_end", vessel.atEnd}});
  return json;
}

Json endsJson(const std::vector<convert::OpenEnd>& ends, const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::OpenEnd& end : ends)
    json.push_back({{"position", vectorJson(toEigen(tree.centre[end.node]))},
                    {"branch", convert::labelOf(tree, end.node)},
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
  json["dark_share"] = jsonNumber(convert::share(report.dark.volume, report.lumenVolume));
  json["dark_places"] = regionsJson(report.dark, tree);
  json["missing_share"] =
      jsonNumber(convert::share(report.missing.volume, report.missing.volume + report.lumenVolume));
  json["missing_vessels"] = vesselsJson(report.missing, tree);
  json["wide_regions"] = regionsJson(report.missing.wide, tree);
  json["ends"] = endsJson(report.ends, tree);
  json["shown_mm"] = jsonNumber(report.shownLength);
  json["missing_mm"] = jsonNumber(report.missingLength());
  json["coverage_share"] =
      jsonNumber(convert::share(report.shownLength, report.shownLength + report.missingLength()));
  json["branches"] = Json::array();
  for (const auto& branch : report.branches) {
    Json entry;
    entry["label"] = branch.label;
    entry["wall"] = offsetsJson(branch.offsets, report.voxelSize);
    json["branches"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace lumen::engine
