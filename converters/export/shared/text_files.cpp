// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/text_files.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/number_text.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_options.h"
#include "formats/case/case_encoding.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::convert {

/// The files in the list of export/CMakeLists.txt.
std::span<const EmbeddedText> exportTextFiles();

std::string exportText(std::string_view name, std::initializer_list<TextValue> values) {
  const std::size_t slash = name.find('/');
  const std::string file = "targets/" + std::string(name.substr(0, slash)) + "/texts" +
                           std::string(name.substr(std::min(slash, name.size())));
  for (const EmbeddedText& text : exportTextFiles())
    if (text.name == file) return filled(text.bytes, values);
  throw std::logic_error("there is no text " + file);
}

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isWordPart(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Whether the character at `at` could begin a block: a heading, a list, a line.
bool beginsBlock(std::string_view text, std::size_t at) {
  if (at == 0) return std::string_view("#+-=").find(text[0]) != std::string_view::npos;
  const bool endsNumber = text[at] == '.' || text[at] == ')';
  return endsNumber && text.find_first_not_of("0123456789") == at;
}

/// Whether the character at `at` is within "://" or "www.", of which GitHub makes links.
bool isOfAddress(std::string_view text, std::size_t at) {
  return (text[at] == ':' && text.substr(at, 3) == "://") ||
         (text[at] == '.' && at >= 3 && text.substr(at - 3, 3) == "www");
}

bool isMarkup(std::string_view text, std::size_t at) {
  const char c = text[at];
  if (std::string_view("\\`*[]<>|~&!").find(c) != std::string_view::npos) return true;
  if (c == '_')  // emphasis has one of its marks at the edge of a word
    return at == 0 || at + 1 == text.size() || !isWordPart(text[at - 1]) ||
           !isWordPart(text[at + 1]);
  return beginsBlock(text, at) || isOfAddress(text, at);
}

}  // namespace

std::string markdownText(std::string_view text) {
  const std::string line = formats::printable(text);
  std::string out;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (isMarkup(line, at)) out += '\\';
    out += line[at];
  }
  return out;
}

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

/// A system of vessels, and the branches that it has.
struct SystemBranches {
  formats::VesselSystem system = formats::VesselSystem::Unknown;
  std::vector<std::string> labels;
};

/// In the order of their values; none if the case states no systems.
std::vector<SystemBranches> systemsOf(const formats::Case& source) {
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(source);
  std::vector<SystemBranches> all;
  for (std::size_t i = 0; i < formats::kVesselSystemCount; ++i) {
    SystemBranches one{static_cast<formats::VesselSystem>(i), {}};
    for (std::size_t b = 0; b < systems.size(); ++b)
      if (systems[b] == one.system) one.labels.push_back(source.tree.branches[b].label);
    if (!one.labels.empty()) all.push_back(std::move(one));
  }
  return all;
}

Json systemsJson(const std::vector<SystemBranches>& systems) {
  Json list = Json::array();
  for (const SystemBranches& one : systems)
    list.push_back({{"name", systemName(one.system)},
                    {"color", systemColorHex(one.system)},
                    {"branches", one.labels}});
  return list;
}

std::string systemsTable(const std::vector<SystemBranches>& systems) {
  if (systems.empty()) return "";
  std::string text = "\n## Systems of vessels\n\n| system | colour | branches |\n|---|---|---|\n";
  for (const SystemBranches& one : systems)
    text += "| " + systemName(one.system) + " | `" + systemColorHex(one.system) + "` | " +
            std::to_string(one.labels.size()) + " |\n";
  return text + "\n`lumen-export.json` lists the branches by name.\n";
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
                       const formats::Case& source, const ExportResult& result) {
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
  text += endsTable(frame, result.ends) + systemsTable(systemsOf(source));
  return text + "\nMade by lumen " LUMEN_VERSION ".\n";
}

std::string makeManifest(const TargetRow& target, const ExportFrame& frame,
                         const formats::Case& source, const OptionTexts& options,
                         const ExportResult& result) {
  Json json = {{"format", "lumen-export"},
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
  if (const auto systems = systemsOf(source); !systems.empty())
    json["systems"] = systemsJson(systems);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lumen::convert
