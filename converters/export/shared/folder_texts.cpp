// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/folder_texts.h"

#include <cstddef>
#include <span>

#include <nlohmann/json.hpp>

#include "converters/base/number_text.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/export/shared/markdown_text.h"
#include "converters/io/mesh/face_kind.h"
#include "formats/case/binary_encode.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kDigits = 5;  // digits of numbers in README.md

Json vectorJson(const Eigen::Vector3d& v) {
  // adding zero: no negative zeros, so that equal folders have equal texts
  return Json::array({v.x() + 0.0, v.y() + 0.0, v.z() + 0.0});
}

Json endsJson(const ExportFrame& frame, const std::vector<NamedEnd>& ends) {
  Json list = Json::array();
  for (const NamedEnd& end : ends)
    list.push_back({{"name", end.name},
                    {"kind", faceKindName(end.kind)},
                    {"position", vectorJson(frame.position(end.position))},
                    {"direction", vectorJson(frame.direction(end.direction))},
                    {"radius", frame.length(end.radius)}});
  return list;
}

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

Json filesJson(const std::vector<ExportFile>& files) {
  Json list = Json::array();
  for (const ExportFile& file : files) {
    Json one = {
        {"name", file.name}, {"bytes", file.bytes.size()}, {"sha256", sha256(bytesOf(file.bytes))}};
    if (!file.unit.empty()) one["unit"] = file.unit;
    list.push_back(std::move(one));
  }
  return list;
}

Json matrixJson(const Eigen::Matrix4d& m) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({m(row, 0) + 0.0, m(row, 1) + 0.0, m(row, 2) + 0.0, m(row, 3) + 0.0});
  return rows;
}

std::string filesTable(const ExportResult& result) {
  std::string text = "| file | |\n|---|---|\n";
  const auto add = [&text](const std::string& name, const std::string& about) {
    text += "| `" + name + "` | " + about + " |\n";
  };
  for (const ExportFile& file : result.files)
    if (!file.about.empty()) add(file.name, file.about);
  for (const auto& [name, about] : result.others) add(name, about);
  add("lumen-export.json",
      "the same for programs: target, options, units, frame, ends, files with SHA-256");
  return text;
}

std::string endsTable(const ExportFrame& frame, const std::vector<NamedEnd>& ends) {
  if (ends.empty()) return "";
  const std::string unit(unitName(frame.unit));
  std::string text = "\n## Ends of the vessels\n\n| name | position, " + unit +
                     " | direction, out of the vessel | radius, " + unit +
                     " |\n|---|---|---|---|\n";
  for (const NamedEnd& end : ends)
    text += "| " + markdownText(end.name) + " | " +
            vectorText(frame.position(end.position), kDigits) + " | " +
            vectorText(frame.direction(end.direction), kDigits) + " | " +
            numberText(frame.length(end.radius), kDigits) + " |\n";
  return text;
}

}  // namespace

std::string readmeText(const TargetRow& target, const ExportFrame& frame,
                       const ExportResult& result) {
  std::string text = "# Vessels for " + std::string(target.title) + "\n\n" + result.start;
  text += "\n## Files\n\n" + filesTable(result);
  text += "\n## Units and frame\n\nLengths are in " + std::string(unitName(frame.unit)) +
          " unless a file states otherwise. Axes are those of the patient: " +
          std::string(axesText(frame.axes)) + ", " + std::string(axesName(frame.axes)) +
          ".\nThe origin is that of the volume that the case was made from.\n";
  for (const std::string& assumption : result.assumptions)
    text +=
        "\n**Not certain**: the file of the case's volume left open: " + markdownText(assumption) +
        ".\n";
  for (const std::string& loss : result.losses) text += "\n" + markdownText(loss) + ".\n";
  text += endsTable(frame, result.ends);
  return text + "\nMade by lumen " LUMEN_VERSION ".\n";
}

std::string makeManifest(const TargetRow& target, const ExportFrame& frame,
                         const formats::Case& source, const OptionTexts& options,
                         const ExportResult& result) {
  const Json json = {{"format", "lumen-export"},
                     {"version", kManifestVersion},
                     {"target", target.name},
                     {"title", target.title},
                     {"generator", "lumen " LUMEN_VERSION},
                     {"case", {{"sha256", sha256(formats::encodeBinary(source))}}},
                     {"options", options},
                     {"unit", unitName(frame.unit)},
                     {"axes", axesName(frame.axes)},
                     {"transform", matrixJson(frame.matrix())},
                     {"ends", endsJson(frame, result.ends)},
                     {"remarks", result.remarks},
                     {"losses", result.losses},
                     {"files", filesJson(result.files)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lumen::convert
