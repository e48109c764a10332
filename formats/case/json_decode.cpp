// SPDX-License-Identifier: Apache-2.0
// Declared in case_encoding.h.
#include <charconv>
#include <cmath>

#include "formats/case/case_encoding.h"
#include "formats/case/json_fields.h"
#include "formats/case/json_motion.h"
#include "formats/case/metadata_json.h"
#include "formats/case/motion.h"
#include "formats/case/validate.h"
#include "formats/json/base64.h"
#include "formats/json/json_document.h"
#include "formats/view/case_chunks.h"
#include "formats/view/limits.h"

namespace lumen::formats {
namespace {

// The parts of a case while its text is read; some may be absent.
struct Parts {
  Case value;
  PointSets points;
  BlobbyModels models;
  MotionRows motion;
  ArraySlots slots;
};

void addSlots(Parts& parts) {
  CenterlineTree& tree = parts.value.tree;
  parts.slots.byPointer = {
      {"/tree/centre", {&tree.centre}},           {"/tree/direction", {&tree.direction}},
      {"/tree/radius", {&tree.radius}},           {"/tree/height", {&tree.height}},
      {"/tree/parent", {&tree.parent}},           {"/tree/branch", {&tree.branch}},
      {"/tree/inlierRate", {&tree.inlierRate}},   {"/tree/links", {&tree.links}},
      {"/points/offset", {&parts.points.offset}}, {"/points/position", {&parts.points.position}},
      {"/models/offset", {&parts.models.offset}}, {"/models/centre", {&parts.models.centre}},
      {"/models/width", {&parts.models.width}}};
  addMotionSlots(parts.motion, parts.slots);
}

Branch readBranch(JsonValue value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  Branch branch;
  branch.label = fields.text("label");
  branch.kind = fields.enumeration<BranchKind>("kind", kBranchKindNames);
  branch.parentNode = fields.integer<std::int32_t>("parentNode");
  branch.firstNode = fields.integer<std::uint32_t>("firstNode");
  branch.nodeCount = fields.integer<std::uint32_t>("nodeCount");
  branch.stopReason = fields.enumeration<StopReason>("stopReason", kStopReasonNames);
  if (fields.find("meanInlierRate").has_value())
    branch.meanInlierRate = fields.single("meanInlierRate");
  fields.finish();
  return branch;
}

void readTree(JsonValue value, const ArraySlots& slots, CenterlineTree& tree,
              JsonReadState& state) {
  const std::string place = "/tree/branches";
  JsonFields fields(value, "/tree", state);
  if (const auto branches = fields.require("branches")) {
    if (!branches->isArray()) state.wrongType(place, *branches, "an array");
    for (std::size_t i = 0; i < branches->arraySize(); ++i) {
      if (state.issues.done()) return;
      tree.branches.push_back(readBranch((*branches)[i], place + "/" + std::to_string(i), state));
    }
  }
  requireArrays(slots,
                {"/tree/centre", "/tree/direction", "/tree/radius", "/tree/height", "/tree/parent",
                 "/tree/branch"},
                state);
  // an empty array would count as absent
  if (slots.byPointer.find("/tree/inlierRate")->second.seen && tree.inlierRate.empty())
    state.fail(ErrorCode::ArrayLength, "/tree/inlierRate", "found 0 entries, expected one per node",
               {{"found", "0"}});
  fields.finish();
}

void readPoints(JsonValue value, const ArraySlots& slots, JsonReadState& state) {
  JsonFields fields(value, "/points", state);
  requireArrays(slots, {"/points/offset", "/points/position"}, state);
  fields.finish();
}

void readModels(JsonValue value, const ArraySlots& slots, BlobbyModels& models,
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
  if (minor.ec != std::errc{} || minor.ptr != end || end - major.ptr > 4) return std::nullopt;
  if (text.front() == '0') return std::nullopt;
  return version;
}

// Reads the version; false if the rest of the text cannot be understood.
bool readVersion(JsonFields& fields, JsonReadState& state) {
  const std::string stated = fields.text("version");
  const std::string readerText = fields.text("minimumReader");
  const auto version = parseVersion(stated);
  const auto reader = parseVersion(readerText);
  if (!version || !reader || *reader > *version) {
    state.fail(ErrorCode::Version, "/version",
               "found version \"" + stated.substr(0, 20) + "\" with minimum reader version \"" +
                   readerText.substr(0, 20) + "\"",
               {{"found", stated.substr(0, 20)}});
    return false;
  }
  if (*reader > kFormatVersion) {
    const std::string known = versionText(kFormatVersion);
    state.fail(
        ErrorCode::Version, "/minimumReader",
        "the file needs a reader of version " + readerText + "; this one reads up to " + known,
        {{"found", readerText}, {"expected", known}});
    return false;
  }
  state.fullyKnown = *version <= kFormatVersion;
  return true;
}

template <class Number>
std::optional<Number> numberAs(double value) {
  if constexpr (std::is_same_v<Number, float>) {
    return floatFromDouble(value);
  } else {
    if (!(value >= double{std::numeric_limits<Number>::min()} &&
          value <= double{std::numeric_limits<Number>::max()}))
      return std::nullopt;
    return static_cast<Number>(value);
  }
}

Issue rangeIssue(double value, const std::string& place) {
  const std::string found = std::isfinite(value) ? shortText(value) : "a number beyond all";
  return pointerIssue(ErrorCode::NumberRange, place,
                      "found " + found + ", which does not fit the type of its array",
                      {{"found", found}});
}

template <class Number>
void convertArray(const NumberTexts& from, const std::string& place, std::vector<Number>& to,
                  JsonReadState& state) {
  if (!std::is_same_v<Number, float> && from.firstReal)
    return state.fail(ErrorCode::JsonType, at(place, *from.firstReal),
                      "found a number with a point or an exponent, expected an integer",
                      {{"found", "number"}, {"expected", "an integer"}});
  to.reserve(from.values.size());
  for (std::size_t i = 0; i < from.values.size() && !state.issues.done(); ++i) {
    const auto number = numberAs<Number>(from.values[i]);
    if (!number)
      state.issues.add(ErrorCode::NumberRange,
                       [&] { return rangeIssue(from.values[i], at(place, i)); });
    to.push_back(number.value_or(Number{}));
  }
}

// The values of the arrays that the metadata describes.
void readNodeArrays(Parts& parts, JsonReadState& state) {
  auto& values = parts.slots.nodeArrays;
  for (NodeArray& array : parts.value.nodeArrays) {
    const auto found = values.find(array.name);
    if (found == values.end()) {
      const std::string key = array.name.substr(0, 80);
      state.fail(ErrorCode::JsonKeyMissing, "/nodeArrays", "the object has no \"" + key + "\"",
                 {{"key", key}});
      continue;
    }
    const std::string place = "/nodeArrays/" + jsonPointerToken(array.name);
    std::visit([&](auto& to) { convertArray(found->second, place, to, state); }, array.values);
    values.erase(found);
  }
  for (const auto& [name, unused] : values)
    state.fail(ErrorCode::JsonKeyUnknown, "/nodeArrays/" + jsonPointerToken(name.substr(0, 80)),
               "the metadata do not describe this array", {{"key", name.substr(0, 80)}});
}

OtherChunk readChunk(JsonValue value, const std::string& place, JsonReadState& state) {
  JsonFields fields(value, place, state);
  OtherChunk chunk;
  chunk.type = fields.text("type");
  chunk.version = fields.integer<std::uint16_t>("version");
  chunk.independent = fields.boolean("independent");
  chunk.encoding = fields.integer<std::uint8_t>("encoding");
  const bool hasRawSize = fields.find("rawSize").has_value();
  if (hasRawSize) chunk.rawSize = fields.integer<std::uint64_t>("rawSize");
  if (hasRawSize != (chunk.encoding != 0))
    state.fail(ErrorCode::JsonChunkData, place + "/rawSize",
               "a raw size belongs to chunks of another encoding than 0, and to those alone",
               {{"chunk", chunk.type.substr(0, 4)}});
  const std::string data = fields.text("data");
  fields.finish();
  if (auto bytes = fromBase64(data)) {
    chunk.bytes = *std::move(bytes);
  } else {
    const std::string name = chunk.type.substr(0, 4);
    state.fail(ErrorCode::JsonChunkData, place + "/data", "found no base64 text",
               {{"chunk", name}});
  }
  if (chunk.encoding == 0) chunk.rawSize = chunk.bytes.size();
  return chunk;
}

void readOtherChunks(JsonValue value, std::vector<OtherChunk>& chunks, JsonReadState& state) {
  const std::string place = "/otherChunks";
  if (!value.isArray()) return state.wrongType(place, value, "an array");
  for (std::size_t i = 0; i < value.arraySize(); ++i) {
    if (state.issues.done()) return;
    chunks.push_back(readChunk(value[i], place + "/" + std::to_string(chunks.size()), state));
  }
}

void readCase(JsonFields& fields, Parts& parts, JsonReadState& state) {
  Case& value = parts.value;
  if (const auto metadata = fields.require("metadata")) {
    MetadataDocument read = readMetadata(*metadata, state);
    value.metadata = std::move(read.metadata);
    value.nodeArrays = std::move(read.nodeArrays);
  }
  if (const auto tree = fields.require("tree")) readTree(*tree, parts.slots, value.tree, state);
  if (const auto found = fields.find("points")) {
    readPoints(*found, parts.slots, state);
    value.points = std::move(parts.points);
  }
  if (const auto found = fields.find("models")) {
    readModels(*found, parts.slots, parts.models, state);
    value.models = std::move(parts.models);
  }
  if (const auto found = fields.find("motion"))
    value.motion = readMotion(*found, parts.slots, parts.motion, state);
  if (const auto found = fields.find("nodeArrays"))
    if (!found->isObject()) state.wrongType("/nodeArrays", *found, "an object");
  readNodeArrays(parts, state);
  if (const auto found = fields.find("otherChunks"))
    readOtherChunks(*found, value.otherChunks, state);
  takeMotion(value, state.issues);
  fields.finish();
}

}  // namespace

std::optional<Case> decodeJson(std::string_view text, IssueList& issues) {
  Parts parts;
  addSlots(parts);
  const auto document = parseJson(text, 0, "", parts.slots, issues);
  if (!document) return std::nullopt;

  JsonReadState state(issues);
  JsonFields fields(document->root(), "", state);
  requireText(fields, "format", "lumen", ErrorCode::NotLumen);
  if (issues.failed() || !readVersion(fields, state)) return std::nullopt;
  readCase(fields, parts, state);
  if (issues.failed()) return std::nullopt;
  checkCase(parts.value, issues);
  if (issues.failed()) return std::nullopt;
  return std::move(parts.value);
}

Expected<Case> decodeJson(std::string_view text) {
  IssueList issues(1, IssueList::Keep::Errors);
  auto value = decodeJson(text, issues);
  if (auto error = issues.firstError()) return *std::move(error);
  return *std::move(value);
}

}  // namespace lumen::formats
