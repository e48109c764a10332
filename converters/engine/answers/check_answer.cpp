// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/check_answer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
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
  json["contrast_to_noise"] = jsonNumber(o.contrastToNoise);
  json["beyond_voxel_share"] = jsonNumber(o.beyondVoxel);
  json["no_edge_share"] = jsonNumber(o.noEdge);
  json["wrong_polarity_share"] = jsonNumber(o.wrongPolarity);
  return json;
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

Json sharedJson(const std::vector<convert::SharedLumen>& shared,
                const formats::CenterlineTree& tree) {
  Json json = Json::array();
  for (const convert::SharedLumen& each : shared)
    json.push_back({{"position", vectorJson(toEigen(tree.centre[each.node]))},
                    {"branch", convert::labelOf(tree, each.node)},
                    {"other", tree.branches[each.other].label},
                    {"node", each.node},
                    {"length_mm", jsonNumber(each.length)},
                    {"depth_mm", jsonNumber(each.depth)},
                    {"diameter_share", jsonNumber(each.share)}});
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
  json["shared_lumen"] = sharedJson(report.shared, tree);
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

constexpr std::size_t kPlacesShown = 10;  // places of each kind; --json has all

std::vector<std::string> offsetsRow(const std::string& label, const convert::Offsets& o,
                                    double voxel) {
  return {label,
          std::to_string(o.samples),
          fixedText(o.median, 3),
          fixedText(o.median / voxel, 2),
          fixedText(o.absoluteMedian / voxel, 2),
          fixedText(o.absoluteP90 / voxel, 2),
          convert::percentText(o.beyondVoxel),
          convert::percentText(o.noEdge),
          convert::percentText(o.wrongPolarity),
          std::to_string(o.beside)};
}

/// The lines of the first kPlacesShown of `list`, and how many more there are.
template <class List, class Line>
std::string firstLines(const List& list, const std::string& singular, const std::string& plural,
                       Line&& line) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kPlacesShown, list.size()); ++i)
    text += line(list[i]) + "\n";
  if (list.size() > kPlacesShown)
    text += counted(list.size() - kPlacesShown, singular, plural) + "; " + kOption.json.shown() +
            " lists them\n";
  return text;
}

/// "1.5 mm3 ", "1520 mm3"
std::string volumeText(double mm3) {
  return fixedText(mm3, mm3 < 100 ? 1 : 0) + " mm3";
}

std::string darkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  return convert::percentText(convert::share(report.dark.volume, report.lumenVolume)) +
         " of the lumen's volume is dark and farther than a voxel from its wall\n" +
         firstLines(report.dark.regions, "smaller dark place", "smaller dark places",
                    [&](const convert::Region& region) {
                      return "the lumen of " +
                             formats::printable(convert::labelOf(tree, region.node)) + " at " +
                             convert::placeText(region.position) + " is dark over " +
                             volumeText(region.volume);
                    });
}

std::string endsText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  const std::vector<convert::OpenEnd> onward = convert::endsThatStopShort(report);
  return counted(report.ends.size() - onward.size(), "open end", "open ends") + " of " +
         std::to_string(report.ends.size()) + " reach as far as the volume shows their vessel\n" +
         firstLines(onward, "more end stops short", "more ends stop short",
                    [&](const convert::OpenEnd& end) {
                      return formats::printable(convert::labelOf(tree, end.node)) +
                             (end.first ? " begins at " : " ends at ") +
                             convert::placeText(toEigen(tree.centre[end.node])) +
                             ", and the vessel goes on for about " + fixedText(end.goesOn, 0) +
                             " mm";
                    });
}

std::string sharedText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  if (report.shared.empty()) return "no two vessels share lumen beyond their joint\n";
  return counted(report.shared.size(), "pair of vessels shares", "pairs of vessels share") +
         " lumen beyond their joint\n" +
         firstLines(
             report.shared, "more pair shares less", "more pairs share less",
             [&](const convert::SharedLumen& each) {
               return formats::printable(convert::labelOf(tree, each.node)) + " and " +
                      formats::printable(tree.branches[each.other].label) + " share lumen at " +
                      convert::placeText(toEigen(tree.centre[each.node])) + ", " +
                      fixedText(each.depth, 1) + " mm deep (" + convert::percentText(each.share) +
                      " of the thinner one), over " + fixedText(each.length, 1) + " mm";
             });
}

std::string missingText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  const double missing = report.missingLength(), whole = report.shownLength + missing;
  return "the case has " + fixedText(report.shownLength, 1) + " of " + fixedText(whole, 1) +
         " mm (" + convert::percentText(convert::share(report.shownLength, whole)) +
         ") of the vessels that are connected with it in the volume\n" +
         firstLines(report.missing.vessels, "shorter vessel is not in the case",
                    "shorter vessels are not in the case",
                    [&](const convert::MissingVessel& vessel) {
                      return "a vessel of " + fixedText(vessel.length, 1) + " mm and radius " +
                             fixedText(vessel.radius, 1) + " mm at " +
                             convert::placeText(convert::middleOf(vessel)) + ", beside " +
                             formats::printable(convert::labelOf(tree, vessel.path.front().node)) +
                             ", is not in the case";
                    }) +
         firstLines(report.missing.wide.regions, "smaller wide region", "smaller wide regions",
                    [&](const convert::Region& region) {
                      return "a bright region of " + volumeText(region.volume) + " at " +
                             convert::placeText(region.position) + ", beside " +
                             formats::printable(convert::labelOf(tree, region.node)) +
                             ", is wider than every vessel of the case";
                    });
}

}  // namespace

std::string checkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"branch", "samples", "offset", "voxels", "median", "p90", "beyond", "no edge",
                  "reversed", "beside"});
  for (const auto& branch : report.branches)
    rows.push_back(offsetsRow(formats::printable(branch.label), branch.offsets, report.voxelSize));
  rows.push_back(offsetsRow("(all)", report.offsets, report.voxelSize));
  return alignColumns(rows) +
         "\noffset of the wall from the half-maximum edge: median in mm and voxels, positive where "
         "the model\nis too wide; median and 90th percentile of its size in voxels. Shares of the "
         "samples: farther than\na voxel, without an edge, dark inside and bright outside. Beside: "
         "samples where another part of the\ntree begins, not judged. One voxel is " +
         fixedText(report.voxelSize, 3) + " mm; blur taken as " +
         fixedText(report.options.pointSpread, 3) + " mm.\n\n" + darkText(report, tree) +
         endsText(report, tree) + sharedText(report, tree) + missingText(report, tree);
}

namespace {

constexpr int kPlaceDecimals = 2;  // a hundredth of a mm

Json placeJson(const std::optional<convert::GatePlace>& place,
               const formats::CenterlineTree& tree) {
  if (!place) return nullptr;
  return {{"measure", place->measure},
          {"position", vectorJson(place->position)},
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
            formats::printable(convert::shellLine(view)) + "\n";
  return text;
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
