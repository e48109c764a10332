// SPDX-License-Identifier: Apache-2.0
// From JSON to metadata; declared in metadata_json.h.
#include "formats/case/json_document.h"
#include "formats/case/metadata_json.h"

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
  if (value.is_string()) return value.get<std::string>();
  if (!isNumber(value)) {
    state.wrongType(place, value, "a boolean, a number or a string");
    return false;
  }
  if (isWhole(value)) {
    if (const auto number = asInteger<std::int64_t>(value)) return *number;
  } else if (const auto number = asDouble(value)) {
    return *number;
  }
  state.outOfRange(place, value,
                   isWhole(value) ? "an integer of 64 bits with a sign (a real has a point)"
                                  : "a number that rounds to an f64");
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
      state.wrongType(at, *parameters, "an object");
    else
      for (const auto& [name, parameter] : parameters->items())
        step.parameters[name] = readParameter(parameter, at + "/" + jsonPointerToken(name), state);
  }
  fields.finish();
  return step;
}

PointQuantisation readQuantisation(const json& value, const std::string& place,
                                   JsonReadState& state) {
  JsonFields fields(value, place, state);
  PointQuantisation quantisation;
  quantisation.bits = fields.integer<std::int32_t>("bits");
  quantisation.step = fields.real("step");
  fields.finish();
  return quantisation;
}

NodeArray readNodeArray(const json& value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  NodeArray array;
  array.name = fields.text("name");
  const auto type = fields.enumeration<std::uint8_t>("type", kArrayTypeNames);
  if (type == 1) array.values = std::vector<std::int32_t>();
  if (type == 2) array.values = std::vector<std::uint32_t>();
  array.components = fields.integer<std::uint32_t>("components");
  if (fields.find("unit") != nullptr) array.unit = fields.text("unit");
  fields.finish();
  return array;
}

// The objects of the array `value`, each by `read`.
template <class Item, class Read>
void readList(const json& value, const std::string& place, std::vector<Item>& to,
              JsonReadState& state, Read read) {
  if (!value.is_array()) return state.wrongType(place, value, "an array");
  for (const json& item : value) {
    if (state.issues.done()) return;
    to.push_back(read(item, place + "/" + std::to_string(to.size()), state));
  }
}

}  // namespace

void requireText(JsonFields& fields, std::string_view key, std::string_view expected,
                 ErrorCode code) {
  const json* value = fields.require(key);
  if (value == nullptr) return;
  if (!value->is_string()) return fields.state().wrongType(fields.placeOf(key), *value, "a string");
  const std::string found = value->get<std::string>().substr(0, 80);
  if (found != expected)
    fields.state().fail(code, fields.placeOf(key),
                        "found \"" + found + "\", expected \"" + std::string(expected) + "\"",
                        {{"found", found}, {"expected", std::string(expected)}});
}

MetadataDocument readMetadata(const json& value, JsonReadState& state) {
  const std::string place = "/metadata";
  JsonFields fields(value, place, state);
  requireText(fields, "coordinateSystem", kCoordinateSystem, ErrorCode::CoordinateSystem);
  requireText(fields, "units", kUnits, ErrorCode::Units);
  MetadataDocument document;
  Metadata& metadata = document.metadata;
  if (fields.find("voxelSize") != nullptr) metadata.voxelSize = fields.real("voxelSize");
  if (const json* source = fields.find("source"))
    metadata.source = readSource(*source, place + "/source", state);
  if (fields.find("parentSha256") != nullptr) {
    metadata.parentSha256 = fields.text("parentSha256");
    if (metadata.parentSha256.empty()) metadata.parentSha256 = " ";  // refused; "" means none
  }
  if (const json* found = fields.find("pointQuantisation"))
    metadata.pointQuantisation = readQuantisation(*found, place + "/pointQuantisation", state);
  if (fields.find("note") != nullptr) {
    metadata.note = fields.text("note");
    if (metadata.note.empty())
      state.fail(ErrorCode::TextLength, place + "/note", "the text is empty");
  }
  if (fields.find("extensionsUsed") != nullptr)
    metadata.extensionsUsed = fields.texts("extensionsUsed");
  if (fields.find("extensionsRequired") != nullptr)
    metadata.extensionsRequired = fields.texts("extensionsRequired");
  if (const json* arrays = fields.find("nodeArrays"))
    readList(*arrays, place + "/nodeArrays", document.nodeArrays, state, readNodeArray);
  if (const json* steps = fields.require("steps"))
    readList(*steps, place + "/steps", metadata.steps, state, readStep);
  fields.finish();
  return document;
}

MetadataDocument decodeMetadataJson(std::string_view text, std::size_t byteOffset, bool fullyKnown,
                                    IssueList& issues) {
  ArraySlots none;
  const auto document = parseJson(text, byteOffset, "/metadata", none, issues);
  if (!document) return {};
  JsonReadState state{issues, fullyKnown};
  return readMetadata(*document, state);
}

}  // namespace lumen::formats
