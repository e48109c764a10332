// SPDX-License-Identifier: Apache-2.0
// Metadata from JSON; declared in metadata_json.h.
#include "formats/case/metadata_json.h"
#include "formats/json/json_document.h"

namespace lumen::formats {
namespace {

SourceVolume readSource(JsonValue value, const std::string& place, JsonReadState& state) {
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

ParameterValue readParameter(JsonValue value, const std::string& place, JsonReadState& state) {
  if (const auto truth = value.boolean()) return *truth;
  if (value.text() != nullptr) return *value.text();
  const auto number = value.number();
  if (!number) {
    state.wrongType(place, value, "a boolean, a number or a string");
    return false;
  }
  if (number->isWhole()) {
    if (const auto whole = number->asInteger<std::int64_t>()) return *whole;
  } else if (const auto real = number->asDouble()) {
    return *real;
  }
  state.outOfRange(place, *number,
                   number->isWhole() ? "an integer of 64 bits with a sign (a real has a point)"
                                     : "a number that rounds to an f64");
  return false;
}

Step readStep(JsonValue value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  Step step;
  step.name = fields.text("name");
  step.tool = fields.text("tool");
  if (const auto parameters = fields.require("parameters")) {
    const std::string at = place + "/parameters";
    if (!parameters->isObject())
      state.wrongType(at, *parameters, "an object");
    else
      for (const auto& [name, parameter] : parameters->members())
        step.parameters[std::string(name)] =
            readParameter(parameter, at + "/" + jsonPointerToken(name), state);
  }
  fields.finish();
  return step;
}

PointQuantisation readQuantisation(JsonValue value, const std::string& place,
                                   JsonReadState& state) {
  JsonFields fields(value, place, state);
  PointQuantisation quantisation;
  quantisation.bits = fields.integer<std::int32_t>("bits");
  quantisation.step = fields.real("step");
  fields.finish();
  return quantisation;
}

NodeArray readNodeArray(JsonValue value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  NodeArray array;
  array.name = fields.text("name");
  const auto type = fields.enumeration<std::uint8_t>("type", kArrayTypeNames);
  if (type == 1) array.values = std::vector<std::int32_t>();
  if (type == 2) array.values = std::vector<std::uint32_t>();
  array.components = fields.integer<std::uint32_t>("components");
  if (fields.find("unit")) array.unit = fields.text("unit");
  fields.finish();
  return array;
}

// The objects of the array `value`, each by `read`.
template <class Item, class Read>
void readList(JsonValue value, const std::string& place, std::vector<Item>& to,
              JsonReadState& state, Read read) {
  if (!value.isArray()) return state.wrongType(place, value, "an array");
  for (std::size_t i = 0; i < value.arraySize(); ++i) {
    if (state.issues.done()) return;
    to.push_back(read(value[i], place + "/" + std::to_string(to.size()), state));
  }
}

}  // namespace

void requireText(JsonFields& fields, std::string_view key, std::string_view expected,
                 ErrorCode code) {
  const auto value = fields.require(key);
  if (!value) return;
  if (value->text() == nullptr)
    return fields.state().wrongType(fields.placeOf(key), *value, "a string");
  const std::string found = value->text()->substr(0, 80);
  if (found != expected)
    fields.state().fail(code, fields.placeOf(key),
                        "found \"" + found + "\", expected \"" + std::string(expected) + "\"",
                        {{"found", found}, {"expected", std::string(expected)}});
}

MetadataDocument readMetadata(JsonValue value, JsonReadState& state) {
  const std::string place = "/metadata";
  JsonFields fields(value, place, state);
  requireText(fields, "coordinateSystem", kCoordinateSystem, ErrorCode::CoordinateSystem);
  requireText(fields, "units", kUnits, ErrorCode::Units);
  MetadataDocument document;
  Metadata& metadata = document.metadata;
  if (fields.find("voxelSize")) metadata.voxelSize = fields.real("voxelSize");
  if (const auto source = fields.find("source"))
    metadata.source = readSource(*source, place + "/source", state);
  if (fields.find("parentSha256")) {
    metadata.parentSha256 = fields.text("parentSha256");
    if (metadata.parentSha256.empty()) metadata.parentSha256 = " ";  // refused; "" means none
  }
  if (const auto found = fields.find("pointQuantisation"))
    metadata.pointQuantisation = readQuantisation(*found, place + "/pointQuantisation", state);
  if (fields.find("note")) {
    metadata.note = fields.text("note");
    if (metadata.note.empty())
      state.fail(ErrorCode::TextLength, place + "/note", "the text is empty");
  }
  if (fields.find("extensionsUsed")) metadata.extensionsUsed = fields.texts("extensionsUsed");
  if (fields.find("extensionsRequired"))
    metadata.extensionsRequired = fields.texts("extensionsRequired");
  if (const auto arrays = fields.find("nodeArrays"))
    readList(*arrays, place + "/nodeArrays", document.nodeArrays, state, readNodeArray);
  if (const auto steps = fields.require("steps"))
    readList(*steps, place + "/steps", metadata.steps, state, readStep);
  fields.finish();
  return document;
}

MetadataDocument decodeMetadataJson(std::string_view text, std::size_t byteOffset, bool fullyKnown,
                                    IssueList& issues) {
  const auto document = parseJson(text, byteOffset, "/metadata", issues);
  if (!document) return {};
  JsonReadState state(issues, fullyKnown);
  return readMetadata(document->root(), state);
}

}  // namespace lumen::formats
