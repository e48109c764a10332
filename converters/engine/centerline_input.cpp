// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/centerline_input.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/mesh_input.h"
#include "converters/engine/scope.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

std::size_t branchCount(const convert::CenterlineFile& file) {
  return convert::centerlineChains(file).size();
}

std::size_t rootCount(const convert::CenterlineFile& file) {
  return static_cast<std::size_t>(
      std::count_if(file.points.begin(), file.points.end(),
                    [](const auto& point) { return point.parent == convert::kNoPoint; }));
}

}  // namespace

void addFrameRow(OptionTable& table, std::string& frame) {
  table.group("Mesh or centerline");
  table
      .add(kOption.frame.name, &frame, "FRAME",
           "Axes of the coordinates of a mesh or centerline, whatever its file states: lps, or ras "
           "[lps where the file does not state them]")
      .among(std::vector<std::string>{"lps", "ras"})
      .forInputs(kMeshes | kCenterline);
  table.group("");
}

LoadedCenterline loadCenterline(const InputFile& file, const FileFormat& format,
                                const VolumeArguments& volume, const std::string& frame,
                                Progress& progress) {
  LoadedCenterline loaded;
  loaded.file = format.readCenterline(file);
  if (!loaded.file.points.empty() && !(convert::measureExtent(loaded.file).length > 0))
    throw invalidInput(
        formats::printable(file.path().string()) +
        (loaded.file.points.size() == 1 ? ": holds one point" : ": holds lines of no length") +
        "; expected vessels, as lines of at least two places");
  convert::CenterlineReading reading;
  reading.unit = volume.options().unit;
  reading.word = optionWord();
  if (frame == "ras") reading.axes = convert::CenterlineAxes::Ras;
  if (frame == "lps") reading.axes = convert::CenterlineAxes::Lps;
  loaded.frame = convert::toPatientSpace(loaded.file, reading);
  for (const std::string& remark : loaded.file.remarks)
    warn(progress,
         about(formats::printable(file.path().string()), {WarningCode::FileAssumption, remark}));
  return loaded;
}

std::string centerlineInfoText(const LoadedCenterline& centerline) {
  const convert::CenterlineFile& file = centerline.file;
  const convert::CenterlineExtent extent = convert::measureExtent(file);
  Lines lines(kNarrowColumn);
  lines.add("points", std::to_string(file.points.size()));
  lines.add("branches", std::to_string(branchCount(file)) + " of " +
                            counted(rootCount(file), "tree", "trees") + ", " +
                            counted(file.links.size(), "loop", "loops"));
  lines.add("length",
            fixedText(extent.length, 1) + " mm, within " + fixedText(extent.diagonal, 1) + " mm");
  lines.add("radius", extent.most > 0
                          ? fixedText(extent.median, 3) + " mm (" + fixedText(extent.least, 3) +
                                " to " + fixedText(extent.most, 3) + ")"
                          : "none");
  lines.add("unit", unitText(centerline.frame));
  return lines.add("axes", axesText(centerline.frame)).text();
}

Json centerlineInfoJson(const LoadedCenterline& centerline) {
  const convert::CenterlineFile& file = centerline.file;
  const convert::CenterlineExtent extent = convert::measureExtent(file);
  Json json;
  json["points"] = file.points.size();
  json["branches"] = branchCount(file);
  json["trees"] = rootCount(file);
  json["links"] = file.links.size();
  json["length_mm"] = jsonNumber(extent.length);
  json["diagonal_mm"] = jsonNumber(extent.diagonal);
  json["radius_mm"] = Json(nullptr);
  if (extent.most > 0)
    json["radius_mm"] = {{"median", jsonNumber(extent.median)},
                         {"min", jsonNumber(extent.least)},
                         {"max", jsonNumber(extent.most)}};
  json["unit_mm"] = jsonNumber(centerline.frame.unit);
  json["unit_from"] = centerline.frame.unitFrom;
  json["frame_stated"] = centerline.frame.frameStated;
  return json;
}

}  // namespace lumen::engine
