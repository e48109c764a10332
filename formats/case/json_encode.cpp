// SPDX-License-Identifier: Apache-2.0
// Declared in case_encoding.h.
#include <variant>

#include "formats/case/case_encoding.h"
#include "formats/case/enum_names.h"
#include "formats/case/metadata_json.h"
#include "formats/case/motion.h"
#include "formats/container/container.h"
#include "formats/json/base64.h"
#include "formats/json/json_writer.h"

namespace lumen::formats {
namespace {

void writeSource(JsonWriter& json, const SourceVolume& source) {
  json.beginObject();
  json.key("size").beginArray(true);
  for (const std::uint32_t count : source.size) json.integer(count);
  json.end();
  json.key("spacing").array(source.spacing);
  json.key("origin").array(source.origin);
  json.key("direction").array(source.direction);
  json.key("sha256").text(source.sha256);
  json.end();
}

struct ParameterWriter {
  JsonWriter& json;
  void operator()(bool value) const { json.boolean(value); }
  void operator()(std::int64_t value) const { json.integer(value); }
  void operator()(double value) const { json.real(value); }
  void operator()(const std::string& value) const { json.text(value); }
};

void writeStep(JsonWriter& json, const Step& step) {
  json.beginObject();
  json.key("name").text(step.name);
  json.key("tool").text(step.tool);
  json.key("parameters").beginObject();
  for (const auto& [name, value] : step.parameters) {
    json.key(name);
    std::visit(ParameterWriter{json}, value);
  }
  json.end();
  json.end();
}

void writeBranch(JsonWriter& json, const Branch& branch) {
  json.beginObject(true);
  json.key("label").text(branch.label);
  json.key("kind").text(enumName(kBranchKindNames, branch.kind));
  json.key("parentNode").integer(branch.parentNode);
  json.key("firstNode").integer(branch.firstNode);
  json.key("nodeCount").integer(branch.nodeCount);
  json.key("stopReason").text(enumName(kStopReasonNames, branch.stopReason));
  if (branch.meanInlierRate) json.key("meanInlierRate").real(*branch.meanInlierRate);
  json.end();
}

template <class Value>
void writeArray(JsonWriter& json, std::string_view name, const std::vector<Value>& values) {
  json.key(name).array(std::span<const Value>(values));
}

void writeTree(JsonWriter& json, const CenterlineTree& tree) {
  json.beginObject();
  json.key("branches").beginArray();
  for (const Branch& branch : tree.branches) writeBranch(json, branch);
  json.end();
  writeArray(json, "centre", tree.centre);
  writeArray(json, "direction", tree.direction);
  writeArray(json, "radius", tree.radius);
  writeArray(json, "height", tree.height);
  writeArray(json, "parent", tree.parent);
  writeArray(json, "branch", tree.branch);
  if (!tree.inlierRate.empty()) writeArray(json, "inlierRate", tree.inlierRate);
  if (!tree.links.empty()) writeArray(json, "links", tree.links);
  json.end();
}

void writePoints(JsonWriter& json, const PointSets& points) {
  json.beginObject();
  writeArray(json, "offset", points.offset);
  writeArray(json, "position", points.position);
  json.end();
}

void writeModels(JsonWriter& json, const BlobbyModels& models) {
  json.beginObject();
  json.key("kernel").text(enumName(kKernelNames, models.kernel));
  json.key("kernelParameter").real(models.kernelParameter);
  json.key("isoLevel").real(models.isoLevel);
  writeArray(json, "offset", models.offset);
  writeArray(json, "centre", models.centre);
  writeArray(json, "width", models.width);
  json.end();
}

// A row for each time, of the values that `part` takes from poses.
template <class Part>
void writePoses(JsonWriter& json, std::string_view name, const Motion& motion, Part part) {
  using Value = decltype(part(motion.pose.front()));
  json.key(name).beginArray();
  const std::size_t nodes = motion.node.size();
  std::vector<Value> row(nodes);
  for (std::size_t t = 0; t < motion.time.size(); ++t) {
    for (std::size_t n = 0; n < nodes; ++n) row[n] = part(motion.pose[t * nodes + n]);
    json.array(std::span<const Value>(row));
  }
  json.end();
}

void writeMotion(JsonWriter& json, const Motion& motion) {
  json.beginObject();
  if (motion.period != 0) json.key("period").real(motion.period);
  writeArray(json, "time", motion.time);
  writeArray(json, "node", motion.node);
  writePoses(json, "centre", motion, [](const Pose& pose) { return pose.centre; });
  writePoses(json, "rotation", motion, [](const Pose& pose) { return pose.rotation; });
  writePoses(json, "factor", motion, [](const Pose& pose) { return pose.factor; });
  json.end();
}

void writeNodeArrays(JsonWriter& json, const std::vector<NodeArray>& arrays) {
  json.beginObject();
  for (const NodeArray& array : arrays)
    std::visit([&](const auto& values) { writeArray(json, array.name, values); }, array.values);
  json.end();
}

void writeOtherChunk(JsonWriter& json, const OtherChunk& chunk) {
  json.beginObject(true);
  json.key("type").text(chunk.type);
  json.key("version").integer(chunk.version);
  json.key("independent").boolean(chunk.independent);
  json.key("encoding").integer(chunk.encoding);
  if (chunk.encoding != 0) json.key("rawSize").size(chunk.rawSize);
  json.key("data").text(base64(chunk.bytes));
  json.end();
}

void writeTexts(JsonWriter& json, std::string_view name, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  json.key(name).beginArray(true);
  for (const std::string& text : texts) json.text(text);
  json.end();
}

void writeArrayInfo(JsonWriter& json, const NodeArray& array) {
  json.beginObject(true);
  json.key("name").text(array.name);
  json.key("type").text(kArrayTypeNames[array.values.index()]);
  json.key("components").integer(array.components);
  if (!array.unit.empty()) json.key("unit").text(array.unit);
  json.end();
}

void writeQuantisation(JsonWriter& json, const PointQuantisation& quantisation) {
  json.beginObject(true);
  json.key("bits").integer(quantisation.bits);
  json.key("step").real(quantisation.step);
  json.end();
}

void writeProvenance(JsonWriter& json, const Metadata& metadata) {
  if (metadata.voxelSize) json.key("voxelSize").real(*metadata.voxelSize);
  if (metadata.source) {
    json.key("source");
    writeSource(json, *metadata.source);
  }
  if (!metadata.parentSha256.empty()) json.key("parentSha256").text(metadata.parentSha256);
  if (metadata.pointQuantisation) {
    json.key("pointQuantisation");
    writeQuantisation(json, *metadata.pointQuantisation);
  }
}

}  // namespace

void writeMetadata(JsonWriter& json, const Metadata& metadata,
                   const std::vector<NodeArray>& nodeArrays) {
  json.beginObject();
  json.key("coordinateSystem").text(kCoordinateSystem);
  json.key("units").text(kUnits);
  writeProvenance(json, metadata);
  if (!metadata.note.empty()) json.key("note").text(metadata.note);
  writeTexts(json, "extensionsUsed", metadata.extensionsUsed);
  writeTexts(json, "extensionsRequired", metadata.extensionsRequired);
  if (!nodeArrays.empty()) {
    json.key("nodeArrays").beginArray();
    for (const NodeArray& array : nodeArrays) writeArrayInfo(json, array);
    json.end();
  }
  json.key("steps").beginArray();
  for (const Step& step : metadata.steps) writeStep(json, step);
  json.end();
  json.end();
}

std::string metadataJson(const Metadata& metadata, const std::vector<NodeArray>& nodeArrays) {
  JsonWriter json(JsonStyle::Compact);
  writeMetadata(json, metadata, nodeArrays);
  return json.take();
}

std::string encodeJson(const Case& value) {
  JsonWriter json(JsonStyle::Readable);
  json.beginObject();
  json.key("format").text("lumen");
  json.key("version").text(versionText(versionOf(value)));
  json.key("minimumReader").text(versionText(kMinimumReader));
  json.key("metadata");
  writeMetadata(json, value.metadata, value.nodeArrays);
  json.key("tree");
  writeTree(json, value.tree);
  if (value.points) {
    json.key("points");
    writePoints(json, *value.points);
  }
  if (value.models) {
    json.key("models");
    writeModels(json, *value.models);
  }
  if (value.motion) {
    json.key("motion");
    writeMotion(json, *value.motion);
  }
  if (!value.nodeArrays.empty()) {
    json.key("nodeArrays");
    writeNodeArrays(json, value.nodeArrays);
  }
  if (!value.otherChunks.empty()) {
    json.key("otherChunks").beginArray();
    for (const OtherChunk& chunk : value.otherChunks) writeOtherChunk(json, chunk);
    json.end();
  }
  json.end();
  return json.take() + "\n";
}

}  // namespace lumen::formats
