// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "formats/case/case_file.h"
#include "formats/case/json_document.h"
#include "formats/case/json_fields.h"
#include "formats/case/metadata_json.h"
#include "formats/container/container.h"

namespace lumen::formats {
namespace {

using nlohmann::json;

SourceVolume readSource(const json& value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  SourceVolume source;
  fields.counts("size", source.size);
  fields.reals("spacing", source.spacing);
  fields.reals("origin", source.origin);
  fields.reals("direction", source.direction);
  source.sha256 = fields.text("sha256");
  fields.finish();
  return source;
}

ParameterValue readParameter(const json& value, const std::string& place, JsonReadState& state) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  state.fail(
      ErrorCode::JsonType, place,
      std::string("found ") + value.type_name() + ", expected a boolean, a number or a string");
  return false;
}

Step readStep(const json& value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  Step step;
  step.name = fields.text("name");
  step.tool = fields.text("tool");
  if (const json* parameters = fields.require("parameters")) {
    const std::string at = place + "/parameters";
    if (!parameters->is_object())
      state.fail(ErrorCode::JsonType, at,
                 std::string("found ") + parameters->type_name() + ", expected an object");
    else
      for (const auto& [name, parameter] : parameters->items())
        step.parameters[name] = readParameter(parameter, at + "/" + jsonPointerToken(name), state);
  }
  fields.finish();
  return step;
}

void readSteps(const json& value, std::vector<Step>& steps, JsonReadState& state) {
  const std::string place = "/metadata/steps";
  if (!value.is_array())
    return state.fail(ErrorCode::JsonType, place,
                      std::string("found ") + value.type_name() + ", expected an array");
  for (const json& step : value) {
    steps.push_back(readStep(step, place + "/" + std::to_string(steps.size()), state));
    if (state.error) return;
  }
}

// The value at `key` must be the one text that the format allows.
void requireText(JsonFields& fields, std::string_view key, std::string_view expected,
                 ErrorCode code) {
  const std::string found = fields.text(key);
  if (found != expected)
    fields.state().fail(
        code, fields.placeOf(key),
        "found \"" + found.substr(0, 80) + "\", expected \"" + std::string(expected) + "\"");
}

Metadata readMetadata(const json& value, JsonReadState& state) {
  const std::string place = "/metadata";
  JsonFields fields(value, place, state);
  requireText(fields, "coordinateSystem", kCoordinateSystem, ErrorCode::CoordinateSystem);
  requireText(fields, "units", kUnits, ErrorCode::Units);
  Metadata metadata;
  if (fields.find("voxelSize") != nullptr) metadata.voxelSize = fields.real("voxelSize");
  if (const json* source = fields.find("source"))
    metadata.source = readSource(*source, place + "/source", state);
  if (const json* steps = fields.require("steps")) readSteps(*steps, metadata.steps, state);
  fields.finish();
  return metadata;
}

Branch readBranch(const json& value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  Branch branch;
  branch.label = fields.text("label");
  branch.kind = fields.enumeration<BranchKind>("kind", kBranchKindNames);
  branch.parentNode = fields.integer<std::int32_t>("parentNode");
  branch.firstNode = fields.integer<std::uint32_t>("firstNode");
  branch.nodeCount = fields.integer<std::uint32_t>("nodeCount");
  branch.stopReason = fields.enumeration<StopReason>("stopReason", kStopReasonNames);
  if (fields.find("meanInlierRate") != nullptr)
    branch.meanInlierRate = floatFromParsed(fields.real("meanInlierRate"));
  fields.finish();
  return branch;
}

void readBranches(const json& value, std::vector<Branch>& branches, JsonReadState& state) {
  const std::string place = "/tree/branches";
  if (!value.is_array())
    return state.fail(ErrorCode::JsonType, place,
                      std::string("found ") + value.type_name() + ", expected an array");
  for (const json& branch : value) {
    branches.push_back(readBranch(branch, place + "/" + std::to_string(branches.size()), state));
    if (state.error) return;
  }
}

void requireArrays(const ArraySlots& slots, std::initializer_list<const char*> pointers,
                   JsonReadState& state) {
  for (const std::string pointer : pointers)
    if (!slots.find(pointer)->second.seen) {
      const std::size_t slash = pointer.rfind('/');
      state.fail(ErrorCode::JsonKeyMissing, pointer.substr(0, slash),
                 "the object has no \"" + pointer.substr(slash + 1) + "\"");
    }
}

void readTree(const json& value, const ArraySlots& slots, CenterlineTree& tree,
              JsonReadState& state) {
  JsonFields fields(value, "/tree", state);
  if (const json* branches = fields.require("branches"))
    readBranches(*branches, tree.branches, state);
  requireArrays(slots,
                {"/tree/centre", "/tree/direction", "/tree/radius", "/tree/height", "/tree/parent",
                 "/tree/branch"},
                state);
  fields.finish();
}

void readPoints(const json& value, const ArraySlots& slots, JsonReadState& state) {
  JsonFields fields(value, "/points", state);
  requireArrays(slots, {"/points/offset", "/points/position"}, state);
  fields.finish();
}

void readModels(const json& value, const ArraySlots& slots, BlobbyModels& models,
                JsonReadState& state) {
  JsonFields fields(value, "/models", state);
  models.kernel = fields.enumeration<Kernel>("kernel", kKernelNames);
  models.kernelParameter = fields.real("kernelParameter");
  models.isoLevel = fields.real("isoLevel");
  requireArrays(slots, {"/models/offset", "/models/centre", "/models/width"}, state);
  fields.finish();
}

std::optional<FormatVersion> parseVersion(std::string_view text) {
  FormatVersion version;
  const char* end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.major);
  if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
  if (minor.ec != std::errc{} || minor.ptr != end || version.major == 0) return std::nullopt;
  return version;
}

void readVersion(JsonFields& fields, JsonReadState& state) {
  const std::string versionText = fields.text("version");
  const std::string readerText = fields.text("minimumReader");
  const auto version = parseVersion(versionText);
  const auto reader = parseVersion(readerText);
  if (!version || !reader || *reader > *version)
    return state.fail(ErrorCode::Version, "/version",
                      "found version \"" + versionText.substr(0, 20) +
                          "\" with minimum reader version \"" + readerText.substr(0, 20) + "\"");
  if (*reader > kFormatVersion)
    return state.fail(ErrorCode::Version, "/minimumReader",
                      "the file needs a reader of version " + readerText +
                          "; this one reads up to " + std::to_string(kFormatVersion.major) + "." +
                          std::to_string(kFormatVersion.minor));
  state.fullyKnown = *version <= kFormatVersion;
}

ArraySlots slotsOf(Case& value, PointSets& points, BlobbyModels& models) {
  CenterlineTree& tree = value.tree;
  return {{"/tree/centre", {&tree.centre}},         {"/tree/direction", {&tree.direction}},
          {"/tree/radius", {&tree.radius}},         {"/tree/height", {&tree.height}},
          {"/tree/parent", {&tree.parent}},         {"/tree/branch", {&tree.branch}},
          {"/tree/inlierRate", {&tree.inlierRate}}, {"/points/offset", {&points.offset}},
          {"/points/position", {&points.position}}, {"/models/offset", {&models.offset}},
          {"/models/centre", {&models.centre}},     {"/models/width", {&models.width}}};
}

}  // namespace

Result<Metadata> decodeMetadataJson(std::string_view text, std::size_t byteOffset,
                                    bool fullyKnown) {
  ArraySlots none;
  const auto document = parseJson(text, byteOffset, "/metadata", none);
  if (!document) return document.error();
  JsonReadState state{fullyKnown, {}};
  Metadata metadata = readMetadata(*document, state);
  if (state.error) return *std::move(state.error);
  return metadata;
}

Result<Case> decodeJson(std::string_view text) {
  Case value;
  PointSets points;
  BlobbyModels models;
  ArraySlots slots = slotsOf(value, points, models);
  const auto document = parseJson(text, 0, "", slots);
  if (!document) return document.error();

  JsonReadState state;
  JsonFields fields(*document, "", state);
  requireText(fields, "format", "lumen", ErrorCode::NotLumen);
  readVersion(fields, state);
  if (state.error) return *std::move(state.error);
  if (const json* metadata = fields.require("metadata"))
    value.metadata = readMetadata(*metadata, state);
  if (const json* tree = fields.require("tree")) readTree(*tree, slots, value.tree, state);
  if (const json* found = fields.find("points")) {
    readPoints(*found, slots, state);
    value.points = std::move(points);
  }
  if (const json* found = fields.find("models")) {
    readModels(*found, slots, models, state);
    value.models = std::move(models);
  }
  fields.finish();
  if (state.error) return *std::move(state.error);
  if (auto valid = validate(value); !valid) return valid.error();
  return value;
}

}  // namespace lumen::formats
