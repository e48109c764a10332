// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/check_answer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/judge/facts/check_facts.h"
#include "formats/container/printable.h"

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

namespace {

constexpr int kPlaceDecimals = 2;  // a hundredth of a mm

Json placeJson(const std::optional<convert::GatePlace>& place,
               const formats::CenterlineTree& tree) {
  if (!place) return nullptr;
  const Eigen::Vector3d& p = place->position;
  return {{"measure", place->measure},
          {"position", {p.x(), p.y(), p.z()}},
          {"branch", convert::labelOf(tree, place->node)},
          {"node", place->node}};
}

std::string_view aboutOf(const std::string& measure) {
  for (const convert::GateMeasure& one : convert::gateMeasures())
    if (one.name == measure) return one.about;
  return {};
}

std::string faultText(const convert::GateFault& fault) {
  const std::string found = std::isnan(fault.found) ? "not known" : shownNumber(fault.found);
  return std::string(aboutOf(fault.threshold.measure)) + ": " + found + ", expected at " +
         (fault.threshold.isLeast ? "least " : "most ") + shownNumber(fault.threshold.limit);
}

std::string sentenceOf(const convert::GateVerdict& verdict) {
  if (verdict.passes()) return "passes";
  std::string text = "needs a person";
  for (const convert::GateFault& fault : verdict.faults)
    text += (&fault == &verdict.faults.front() ? ": " : "; ") + faultText(fault);
  return text;
}

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_./,:=+@%").find(c) != std::string_view::npos;
}

}  // namespace

std::vector<std::string> viewCommand(const convert::GateVerdict& verdict, const std::string& volume,
                                     const std::string& caseFile) {
  if (!verdict.worst) return {};
  const Eigen::Vector3d& p = verdict.worst->position;
  return {"lumen", "view", volume, caseFile,
          "--at=" + fixedText(p.x(), kPlaceDecimals) + "," + fixedText(p.y(), kPlaceDecimals) +
              "," + fixedText(p.z(), kPlaceDecimals)};
}

Json verdictJson(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                 const std::vector<std::string>& view) {
  Json faults = Json::array();
  for (const convert::GateFault& fault : verdict.faults)
    faults.push_back({{"measure", fault.threshold.measure},
                      {"found", jsonNumber(fault.found)},
                      {"least", fault.threshold.isLeast ? Json(fault.threshold.limit) : Json()},
                      {"most", fault.threshold.isLeast ? Json() : Json(fault.threshold.limit)}});
  return {{"profile", verdict.profile},
          {"passes", verdict.passes()},
          {"sentence", sentenceOf(verdict)},
          {"faults", std::move(faults)},
          {"worst", placeJson(verdict.worst, tree)},
          {"view", view}};
}

std::string verdictText(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                        const std::vector<std::string>& view) {
  const std::string profile = "profile " + formats::printable(verdict.profile) + ": ";
  if (verdict.passes()) return "\n" + profile + "passes\n";
  std::string text = "\n" + profile + "needs a person\n";
  for (const convert::GateFault& fault : verdict.faults) text += "  " + faultText(fault) + "\n";
  if (verdict.worst)
    text += "the worst place is at " + convert::placeText(verdict.worst->position) + ", at " +
            formats::printable(convert::labelOf(tree, verdict.worst->node)) + ":\n  " +
            formats::printable(shellLine(view)) + "\n";
  return text;
}

std::string shellLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    line += line.empty() ? "" : " ";
    if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

namespace {

void addScore(Json& json, const convert::CenterlineScore& score,
              const std::optional<convert::Quantiles>& wall) {
  json["overlap"] = jsonNumber(score.overlap);
  json["overlap_until_first_error"] = jsonNumber(score.overlapUntilFirstError);
  json["average_inside_mm"] = jsonNumber(score.averageInside);
  json["assd_mm"] = jsonNumber(score.assd);
  json["assd_limited_mm"] = jsonNumber(score.assdLimited);
  json["radius_bias_mm"] = jsonNumber(score.radiusBias);
  json["radius_rms_mm"] = jsonNumber(score.radiusRms);
  json["missed_mm"] = jsonNumber(score.missed);
  json["false_mm"] = jsonNumber(score.falseLength);
  if (wall)
    json["wall_distance_mm"] = {{"median", jsonNumber(wall->median)},
                                {"p90", jsonNumber(wall->p90)},
                                {"max", jsonNumber(wall->max)}};
  else
    json["wall_distance_mm"] = nullptr;
}

}  // namespace

Json comparisonJson(const convert::Comparison& comparison) {
  Json json;
  addScore(json, comparison.score, comparison.wallDistance);
  json["branches"] = Json::array();
  for (const auto& branch : comparison.branches) {
    Json entry;
    entry["label"] = branch.label;
    addScore(entry, branch.score, branch.wallDistance);
    json["branches"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace lumen::engine
