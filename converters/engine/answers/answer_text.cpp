// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/answer_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/judge/measure/vessel_length.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::engine {

namespace {

std::size_t blobCount(const formats::Case& value) {
  return value.models ? value.models->centre.size() : 0;
}

std::size_t pointCount(const formats::Case& value) {
  return value.points ? value.points->position.size() : 0;
}

}  // namespace

Json jsonNumber(float value) {
  if (!std::isfinite(value)) return nullptr;
  const std::string text = formats::shortText(value);
  double shortest = 0;
  std::from_chars(text.data(), text.data() + text.size(), shortest);
  return shortest;
}

Json jsonNumber(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

Json vectorJson(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json caseSummary(const formats::Case& value) {
  Json json;
  json["branches"] = value.tree.branches.size();
  json["nodes"] = value.tree.nodeCount();
  json["points"] = pointCount(value);
  json["blobs"] = blobCount(value);
  json["length_mm"] = jsonNumber(convert::vesselLengths(value.tree).total);
  return json;
}

std::string caseLine(const std::string& file, const formats::Case& value) {
  return formats::printable(file) + ": " +
         counted(value.tree.branches.size(), "branch", "branches") + ", " +
         counted(value.tree.nodeCount(), "node", "nodes") + ", " +
         counted(pointCount(value), "point", "points") + ", " +
         counted(blobCount(value), "blob", "blobs") + ", " +
         fixedText(convert::vesselLengths(value.tree).total, 1) + " mm\n";
}

FieldWord optionWord(const OptionTable* table) {
  return FieldWord([table](std::string_view field, std::optional<std::size_t> value) {
    std::string text = "--" + std::string(field);
    if (const OptionRow* row = table && value ? table->find(field) : nullptr)
      text += " " + row->givenValues.at(*value);
    return text;
  });
}

operations::Context operationContext(Progress& progress, const OptionTable* table) {
  return {progress, optionWord(table), kOption.json.shown()};
}

}  // namespace lumen::engine
