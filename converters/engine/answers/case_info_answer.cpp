// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/case_info_answer.h"

#include <utility>

#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/engine/answers/volume_info.h"
#include "converters/judge/measure/shown_radius.h"

namespace lumen::engine {

namespace {

std::optional<double> blobsPerNode(const convert::CaseInfo& info) {
  if (!info.blobs || info.nodes == 0) return std::nullopt;
  return static_cast<double>(*info.blobs) / static_cast<double>(info.nodes);
}

/// `least`: of the radii that the volume shows.
Json radiusJson(const RadiusRange& radius, std::optional<double> least) {
  const bool isBound = least && static_cast<double>(radius.min) < *least;
  return {{"mean", jsonNumber(radius.mean)},
          {"min", jsonNumber(radius.min)},
          {"max", jsonNumber(radius.max)},
          {"min_at_most", isBound ? jsonNumber(*least) : Json(nullptr)}};
}

Json provenanceJson(const formats::Metadata& metadata) {
  Json json;
  json["voxel_size_mm"] = metadata.voxelSize ? jsonNumber(*metadata.voxelSize) : Json(nullptr);
  json["source"] = metadata.source ? sourceVolumeJson(*metadata.source) : Json(nullptr);
  json["parent_sha256"] =
      metadata.parentSha256.empty() ? Json(nullptr) : Json(metadata.parentSha256);
  json["point_step_mm"] =
      metadata.pointQuantisation ? jsonNumber(metadata.pointQuantisation->step) : Json(nullptr);
  json["steps"] = stepsJson(metadata);
  return json;
}

Json branchJson(const convert::BranchInfo& branch, std::optional<double> least) {
  Json json;
  json["label"] = branch.label;
  json["parent"] = branch.parent.empty() ? Json(nullptr) : Json(branch.parent);
  json["kind"] = branch.kind;
  json["nodes"] = branch.nodes;
  json["length_mm"] = jsonNumber(branch.length);
  json["radius_mm"] = branch.nodes > 0 ? radiusJson(branch.radius, least) : Json(nullptr);
  json["stop_reason"] = branch.stopReason;
  json["end"] = branch.end;
  json["inlier_rate"] = branch.inlierRate ? jsonNumber(*branch.inlierRate) : Json(nullptr);
  if (!branch.system.empty()) json["system"] = branch.system;
  return json;
}

std::string branchTable(const convert::CaseInfo& info) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back(
      {"branch", "from", "kind", "nodes", "length", "radius", "min", "max", "inliers", "end"});
  const auto radius = [&](float r) {
    return convert::shownRadius(static_cast<double>(r), info.leastShown, 3);
  };
  for (const auto& b : info.branches)
    rows.push_back({b.label, b.parent.empty() ? "-" : b.parent, b.kind, std::to_string(b.nodes),
                    fixedText(b.length, 1), radius(b.radius.mean), radius(b.radius.min),
                    radius(b.radius.max), fixedText(b.inlierRate, 2), b.end});
  for (std::size_t b = 0; b < info.branches.size(); ++b)
    if (const std::string& system = info.branches[b].system; !system.empty())
      rows[b + 1].insert(rows[b + 1].begin() + 3, system);
  if (rows.size() > 1 && rows[1].size() > rows[0].size())
    rows[0].insert(rows[0].begin() + 3, "system");
  return alignColumns(rows);
}

std::string stepText(const formats::Step& step) {
  std::string text = step.name + " (" + step.tool + ")";
  std::string separator = ": ";
  for (const auto& [key, value] : step.parameters) {
    text += separator + key + " " + parameterText(value);
    separator = ", ";
  }
  return text;
}

std::string sourceText(const formats::SourceVolume& source) {
  return joinedNumbers(source.size, " x ") + " voxels of " + joinedNumbers(source.spacing, " x ") +
         " mm, sha256 " + source.sha256;
}

/// "3, 1 network by 2 links".
std::string networkText(const convert::CaseInfo& info) {
  return std::to_string(info.trees) + ", " + counted(info.networks, "network", "networks") +
         (info.links > 0 ? " by " + counted(info.links, "link", "links") : "");
}

std::string motionText(const convert::MotionInfo& motion) {
  std::string text = std::to_string(motion.times) + " times from " + shownNumber(motion.firstTime) +
                     " to " + shownNumber(motion.lastTime) + " s, ";
  text += motion.period > 0 ? "period " + shownNumber(motion.period) + " s" : "not periodic";
  return text + ", " + std::to_string(motion.nodes) + " moving nodes, displacement up to " +
         fixedText(motion.figures.displacement, 3) + " mm, strain up to " +
         fixedText(motion.figures.strain, 3);
}

Json motionJson(const convert::MotionInfo& motion) {
  return {{"times", motion.times},
          {"first_s", jsonNumber(motion.firstTime)},
          {"last_s", jsonNumber(motion.lastTime)},
          {"period_s", motion.period > 0 ? jsonNumber(motion.period) : Json(nullptr)},
          {"nodes", motion.nodes},
          {"displacement_mm", jsonNumber(motion.figures.displacement)},
          {"strain", jsonNumber(motion.figures.strain)}};
}

/// Adds lines for facts that few cases have.
void addExtras(const convert::CaseInfo& info, Lines& lines) {
  const formats::Metadata& metadata = info.metadata;
  if (const auto& rounded = metadata.pointQuantisation)
    lines.add("points", "rounded to " + std::to_string(rounded->bits) + " bits, steps of " +
                            shownNumber(rounded->step) + " mm");
  for (const auto& name : info.nodeArrays) lines.add("node array", name);
  if (info.motion) lines.add("motion", motionText(*info.motion));
  if (const auto& seeds = info.seeds; seeds && seeds->tracked + seeds->waiting > 0)
    lines.add("seeds", std::to_string(seeds->tracked) + " tracked, " +
                           std::to_string(seeds->waiting) + " waiting");
  if (!metadata.parentSha256.empty()) lines.add("made from", "sha256 " + metadata.parentSha256);
  if (!metadata.note.empty()) lines.add("note", metadata.note);
}

}  // namespace

Json caseInfoJson(const convert::CaseInfo& info) {
  Json json;
  const auto perNode = blobsPerNode(info);
  json["branches"] = Json::array();
  for (const auto& branch : info.branches)
    json["branches"].push_back(branchJson(branch, info.leastShown));
  json["nodes"] = info.nodes;
  json["links"] = info.links;
  json["trees"] = info.trees;
  json["networks"] = info.networks;
  json["points"] = info.points;
  json["blobs"] = info.blobs.value_or(0);
  json["blobs_per_node"] = perNode ? jsonNumber(*perNode) : Json(nullptr);
  json["length_mm"] = jsonNumber(info.length);
  json["reachable"] = reachJson(info.reach);
  json["radius_mm"] = nullptr;
  if (info.radius)
    json["radius_mm"] = {{"min", jsonNumber(info.radius->min)},
                         {"max", jsonNumber(info.radius->max)}};
  json["least_shown_radius_mm"] = info.leastShown ? jsonNumber(*info.leastShown) : Json(nullptr);
  json["error_of_fit_mm"] = nullptr;
  if (info.errorOfFit)
    json["error_of_fit_mm"] = {{"median", jsonNumber(info.errorOfFit->median)},
                               {"p90", jsonNumber(info.errorOfFit->p90)},
                               {"max", jsonNumber(info.errorOfFit->max)}};
  json["provenance"] = provenanceJson(info.metadata);
  json["note"] = info.metadata.note.empty() ? Json(nullptr) : Json(info.metadata.note);
  json["node_arrays"] = info.nodeArrays;
  json["motion"] = info.motion ? motionJson(*info.motion) : Json(nullptr);
  json["seeds"] = nullptr;
  if (info.seeds)
    json["seeds"] = {{"tracked", info.seeds->tracked}, {"waiting", info.seeds->waiting}};
  return json;
}

std::string caseInfoText(const convert::CaseInfo& info, const std::string& inlets) {
  Lines lines;
  std::string blobs = std::to_string(info.blobs.value_or(0));
  if (const auto perNode = blobsPerNode(info)) blobs += " (" + fixedText(perNode, 1) + " per node)";
  lines.add("branches", std::to_string(info.branches.size()))
      .add("trees", networkText(info))
      .add("inlets", inlets)
      .add("nodes", std::to_string(info.nodes))
      .add("points", std::to_string(info.points))
      .add("blobs", blobs)
      .add("length", fixedText(info.length, 1) + " mm");
  lines.add("reachable", convert::reachText(info.reach));
  if (info.reach)
    for (const std::string& text : convert::closedTexts(*info.reach)) lines.add("closed", text);
  if (info.radius)
    lines.add("radius",
              convert::shownRadius(static_cast<double>(info.radius->min), info.leastShown, 3) +
                  " to " + fixedText(info.radius->max, 3) + " mm");
  if (const auto& e = info.errorOfFit)
    lines.add("error of fit", "median " + fixedText(e->median, 4) + ", 90th percentile " +
                                  fixedText(e->p90, 4) + ", greatest " + fixedText(e->max, 4) +
                                  " mm");
  if (info.metadata.voxelSize)
    lines.add("voxel size", shownNumber(*info.metadata.voxelSize) + " mm");
  if (info.metadata.source) lines.add("source", sourceText(*info.metadata.source));
  addExtras(info, lines);
  for (const auto& step : info.metadata.steps) lines.add("step", stepText(step));
  std::string text = lines.text() + "\n" + branchTable(info) + "\nLengths and radii in mm.";
  if (info.leastShown)
    text += " <= stands where a radius is below the least that the volume shows, " +
            fixedText(*info.leastShown, 3) + " mm.";
  return text + "\n";
}

Json stepsJson(const formats::Metadata& metadata) {
  Json list = Json::array();
  for (const formats::Step& step : metadata.steps) {
    Json parameters = Json::object();
    for (const auto& [name, value] : step.parameters)
      std::visit([&parameter = parameters[name]](const auto& v) { parameter = v; }, value);
    list.push_back(
        {{"name", step.name}, {"tool", step.tool}, {"parameters", std::move(parameters)}});
  }
  return list;
}

Json reachJson(const std::optional<convert::Reach>& reach) {
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const convert::ClosedPath& path : reach->closed)
    closed.push_back(
        {{"branch", path.branch},
         {"node", path.node},
         {"position",
          {jsonNumber(path.position.x), jsonNumber(path.position.y), jsonNumber(path.position.z)}},
         {"beyond_mm", jsonNumber(path.beyond)}});
  return {{"length_mm", jsonNumber(reach->length)},
          {"of_mm", jsonNumber(reach->of)},
          {"trees", reach->trees},
          {"networks", reach->networks},
          {"longest_tree_mm", jsonNumber(reach->longest)},
          {"closed", std::move(closed)}};
}

}  // namespace lumen::engine
