// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/surface_answer.h"

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/operations/surface_of.h"
#include "formats/container/printable.h"

namespace lumen::engine {
namespace {

Json fieldErrorJson(const std::optional<convert::FieldError>& error) {
  if (!error) return nullptr;
  return {{"greatest_mm", error->greatest},
          {"ninetieth_mm", error->ninetieth},
          {"places", error->places},
          {"beyond", error->beyond}};
}

Json wallJson(const std::optional<convert::WallThickness>& wall) {
  if (!wall) return nullptr;
  return {{"least_mm", wall->least},
          {"least_place", vectorJson(wall->place)},
          {"median_mm", wall->median},
          {"step", convert::WallThickness::kStep},
          {"histogram", wall->histogram}};
}

std::string wallLine(const convert::WallThickness& wall) {
  constexpr std::size_t kFull = 9;  // bins below nine tenths of the thickness
  std::size_t thin = 0;
  for (std::size_t bin = 0; bin < kFull; ++bin) thin += wall.histogram[bin];
  const double share =
      wall.measured == 0 ? 0 : static_cast<double>(thin) / static_cast<double>(wall.measured);
  return "wall         " + fixedText(wall.median, 3) + " mm thick (median), " +
         fixedText(100 * share, 1) + " % under nine tenths of the thickness, least " +
         fixedText(wall.least, 3) + " mm at " + convert::placeText(wall.place) + "\n";
}

}  // namespace

SurfaceFindings examineSurface(const formats::Case& value, Progress& progress) {
  if (!value.models || value.tree.nodeCount() == 0) return {};
  try {
    convert::SurfaceReport report =
        convert::closedSurface(value, operations::SurfaceOptions().closed, progress).report;
    std::vector<Warning> warnings =
        operations::surfaceWarnings(report, value, operationContext(progress));
    return {std::move(report), std::move(warnings)};
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    return {
        std::nullopt,
        {{WarningCode::SurfaceNone, std::string("there is no closed surface: ") + error.what()}}};
  }
}

Json warningsJson(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const Warning& warning : warnings) {
    Json places = Json::array();
    for (const Eigen::Vector3d& place : warning.places) places.push_back(vectorJson(place));
    list.push_back({{"code", warningName(warning.code)},
                    {"text", warning.text},
                    {"places", std::move(places)},
                    {"remedy", warning.remedy.empty() ? Json() : Json(warning.remedy)}});
  }
  return list;
}

std::string surfaceLines(const std::optional<convert::SurfaceReport>& report,
                         const formats::Case& value) {
  if (!report) return "";
  std::string text = "surface      " + counted(report->triangles, "triangle", "triangles") + ", " +
                     counted(report->trees, "closed part", "closed parts") + ", " +
                     counted(report->flatEnds, "flat end", "flat ends");
  if (report->roundedEnds > 0)
    text += ", " + counted(report->roundedEnds, "rounded end", "rounded ends");
  if (const auto& error = report->fieldError)
    text += "\nerror        within " + fixedText(error->ninetieth, 3) +
            " mm of the field at 90 %, " + fixedText(error->greatest, 3) + " mm at most; " +
            counted(error->beyond, "place", "places") + " of " + std::to_string(error->places) +
            " beyond what was asked for, as where the field jumps";
  else if (!report->errors.empty() && report->errors.front() >= 0)
    text += ", within " + fixedText(report->errors.front(), 4) + " mm of that with all triangles";
  text += "\nshape        " + fixedText(report->volume, 1) + " mm3, " + fixedText(report->area, 1) +
          " mm2, least angle " + fixedText(report->leastAngle, 2) + " degrees\n";
  if (report->wall) text += wallLine(*report->wall);
  constexpr std::size_t kMostOverlapLines = 5;
  const auto& branches = value.tree.branches;
  for (std::size_t i = 0; i < std::min(kMostOverlapLines, report->overlaps.size()); ++i) {
    const convert::Overlap& o = report->overlaps[i];
    text += (i == 0 ? "overlap      " : "             ") +
            formats::printable(branches[o.branch].label) + " and " +
            formats::printable(branches[o.other].label) + " by up to " + fixedText(2 * o.depth, 2) +
            " mm at " + convert::placeText(o.place) + "; kept " + fixedText(report->gap, 3) +
            " mm apart\n";
  }
  if (report->overlaps.size() > kMostOverlapLines)
    text += "             and " + std::to_string(report->overlaps.size() - kMostOverlapLines) +
            " more pairs; " + kOption.json.shown() + " lists all\n";
  return text;
}

Json surfaceJson(const std::optional<convert::SurfaceReport>& report, const formats::Case& value) {
  if (!report) return nullptr;
  Json json = {{"trees", report->trees},
               {"vertices", report->vertices},
               {"triangles", report->triangles},
               {"gap_mm", report->gap},
               {"flat_ends", report->flatEnds},
               {"rounded_ends", report->roundedEnds},
               {"opened_edges", report->openedEdges},
               {"off_field", report->offField},
               {"sharp_triangles", report->sharpTriangles},
               {"crossings", report->crossings},
               {"least_angle_deg", report->leastAngle},
               {"volume_mm3", report->volume},
               {"area_mm2", report->area},
               {"field_error", fieldErrorJson(report->fieldError)},
               {"wall", wallJson(report->wall)},
               {"cuts", Json::array()},
               {"overlaps", Json::array()}};
  json["errors_mm"] = Json::array();
  for (const double error : report->errors)
    json["errors_mm"].push_back(error < 0 ? Json() : jsonNumber(error));
  for (const Eigen::Vector3d& place : report->cuts) json["cuts"].push_back(vectorJson(place));
  for (const convert::Overlap& o : report->overlaps)
    json["overlaps"].push_back(
        {{"branches", {value.tree.branches[o.branch].label, value.tree.branches[o.other].label}},
         {"depth_mm", 2 * o.depth},
         {"place", vectorJson(o.place)}});
  return json;
}

}  // namespace lumen::engine
