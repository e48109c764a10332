// SPDX-License-Identifier: Apache-2.0
// Declared in seeds_parse.h.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "converters/base/shown_text.h"
#include "converters/io/seeds/seeds_parse.h"

namespace lumen::convert {
namespace {

using nlohmann::json;

/// The frame of the file, overridden by `reading` where that states one.
SeedFrame parseFrame(const JsonPlace& root, const SeedReading& reading) {
  const JsonPlace system = root.at("coordinateSystem"), units = root.at("units");
  SeedFrame frame;
  if (reading.system)
    frame.system = *reading.system;
  else if (system.text() == "RAS")
    frame.system = SeedSystem::Ras;
  else if (system.text() != "LPS")
    system.refuse("\"LPS\" or \"RAS\"; " + reading.word("seeds-frame") + " states another");
  frame.unit = reading.unit ? *reading.unit : unitInMillimetres(units, reading);
  return frame;
}

SeedPoint parsePoint(const JsonPlace& place, const SeedFrame& frame) {
  if (place.value().isArray()) return {frame.position(place.vector()), std::nullopt};
  if (!place.value().isObject()) place.refuse("[x, y, z], or an object with a position");
  place.onlyKeys({"position", "radius"});
  SeedPoint point{frame.position(place.at("position").vector()), std::nullopt};
  if (place.has("radius")) point.radius = frame.unit * place.at("radius").number();
  return point;
}

/// A branch's own radius applies to a vessel's first point, and to those points of an aneurysm that
/// have none.
void spreadRadius(SeedBranch& branch, double radius) {
  const bool all = branch.kind == formats::BranchKind::Aneurysm;
  const std::size_t count =
      all ? branch.points.size() : std::min<std::size_t>(1, branch.points.size());
  for (std::size_t i = 0; i < count; ++i)
    if (!branch.points[i].radius) branch.points[i].radius = radius;
}

SeedBranch parseBranch(const JsonPlace& place, const SeedFrame& frame) {
  place.onlyKeys(
      {"label", "kind", "parent", "points", "radius", "direction", "comment", "tracked"});
  SeedBranch branch;
  branch.frame = frame;
  branch.label = place.at("label").text();
  if (place.has("kind") && !setKind(place.at("kind").text(), branch))
    place.at("kind").refuse("\"vessel\", \"aneurysm\" or \"root\" for branch " +
                            quotedText(branch.label));
  if (place.has("parent")) branch.parent = place.at("parent").text();
  for (const auto& point : place.at("points").elements())
    branch.points.push_back(parsePoint(point, frame));
  if (place.has("radius")) spreadRadius(branch, frame.unit * place.at("radius").number());
  if (place.has("direction")) branch.direction = frame.direction(place.at("direction").vector());
  if (place.has("comment")) (void)place.at("comment").text();
  if (place.has("tracked")) branch.isTracked = place.at("tracked").boolean();
  return branch;
}

std::string jsonText(const Eigen::Vector3d& v) {
  return json{v.x(), v.y(), v.z()}.dump();
}

std::string branchText(const SeedBranch& branch) {
  std::string text = "    {\n      \"label\": " + json(branch.label).dump() + ",\n";
  text += "      \"kind\": \"" + kindOf(branch) + "\",\n";
  if (branch.parent) text += "      \"parent\": " + json(*branch.parent).dump() + ",\n";
  if (branch.direction) text += "      \"direction\": " + jsonText(*branch.direction) + ",\n";
  if (branch.isTracked) text += "      \"tracked\": true,\n";
  text += "      \"points\": [\n";
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const SeedPoint& p = branch.points[i];
    text += "        {\"position\": " + jsonText(p.position);
    if (p.radius) text += ", \"radius\": " + json(*p.radius).dump();
    text += i + 1 < branch.points.size() ? "},\n" : "}\n";
  }
  return text + "      ]\n    }";
}

}  // namespace

std::vector<SeedBranch> parseSeeds(const JsonPlace& root, const SeedReading& reading) {
  if (!root.has("format"))
    root.refuse(
        "the key \"format\" with \"lumen-seeds\" (lumen's own seeds), or the key \"markups\" (3D "
        "Slicer's)");
  if (!root.at("format").value().is("lumen-seeds"))
    root.at("format").refuse("\"lumen-seeds\": this is no file of seeds");
  root.onlyKeys(
      {"$schema", "format", "version", "comment", "coordinateSystem", "units", "branches"});
  if (!root.at("version").value().is(kSeedsVersion))
    root.at("version").refuse(std::to_string(kSeedsVersion));
  for (const char* key : {"$schema", "comment"})
    if (root.has(key)) (void)root.at(key).text();
  const SeedFrame frame = parseFrame(root, reading);
  std::vector<SeedBranch> branches;
  for (const auto& place : root.at("branches").elements())
    branches.push_back(parseBranch(place, frame));
  return branches;
}

std::string seedsText(const std::vector<SeedBranch>& seeds) {
  std::string text =
      "{\n  \"format\": \"lumen-seeds\",\n  \"version\": " + std::to_string(kSeedsVersion) +
      ",\n  \"coordinateSystem\": \"LPS\",\n"
      "  \"units\": \"mm\",\n  \"branches\": [\n";
  for (std::size_t i = 0; i < seeds.size(); ++i)
    text += branchText(seeds[i]) + (i + 1 < seeds.size() ? ",\n" : "\n");
  return text + "  ]\n}\n";
}

}  // namespace lumen::convert
