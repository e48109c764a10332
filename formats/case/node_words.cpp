// SPDX-License-Identifier: Apache-2.0
// Declared in node_words.h and node_origin.h.
#include "formats/case/node_words.h"

#include <array>
#include <utility>
#include <variant>

#include "formats/case/enum_names.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

using Values = std::vector<std::uint32_t>;

struct Table {
  std::string_view array;
  std::size_t count = 0;
  const char* expected = "";
};
constexpr std::array<Table, 2> kTables = {
    {{kOriginArray, kNodeOriginCount, "an origin from 0 to 2"},
     {kSystemArray, kVesselSystemCount, "a system from 0 to 4"}}};

}  // namespace

const Values* findNodeWords(const Case& value, std::string_view array) {
  const auto found = std::find_if(value.nodeArrays.begin(), value.nodeArrays.end(),
                                  [&](const NodeArray& a) { return a.name == array; });
  if (found == value.nodeArrays.end()) return nullptr;
  const auto* values = std::get_if<Values>(&found->values);
  return values != nullptr && values->size() == value.tree.nodeCount() ? values : nullptr;
}

void setNodeWords(Case& value, const char* extension, const char* array, Words words) {
  auto& used = value.metadata.extensionsUsed;
  std::erase_if(value.nodeArrays, [&](const NodeArray& a) { return a.name == array; });
  std::erase(used, extension);
  std::erase(value.metadata.extensionsRequired, extension);
  if (std::all_of(words.values.begin(), words.values.end(),
                  [](std::uint32_t word) { return word == 0; }))
    return;
  value.nodeArrays.push_back({array, 1, "", std::move(words.values)});
  used.emplace_back(extension);
}

std::optional<Issue> nodeWordFault(const NodeArray& array, const std::string& place) {
  const auto table = std::find_if(kTables.begin(), kTables.end(),
                                  [&](const Table& t) { return t.array == array.name; });
  if (table == kTables.end()) return std::nullopt;
  if (array.components != 1)
    return limitIssue(ErrorCode::NodeArrayComponents, place + "/components", array.components, 1);
  const auto* values = std::get_if<Values>(&array.values);
  if (values == nullptr)
    return foundIssue(ErrorCode::EnumValue, place + "/type",
                      std::string(kArrayTypeNames[array.values.index()]), "u32");
  const auto fault = std::find_if(values->begin(), values->end(),
                                  [&](std::uint32_t value) { return value >= table->count; });
  if (fault == values->end()) return std::nullopt;
  return foundIssue(
      ErrorCode::EnumValue,
      at("/nodeArrays/" + array.name, static_cast<std::size_t>(fault - values->begin())),
      std::to_string(*fault), table->expected);
}

std::vector<NodeOrigin> readNodeOrigins(const Case& value) {
  return readNodeWords<NodeOrigin>(value, kOriginArray);
}

void setNodeOrigins(Case& value, const std::vector<NodeOrigin>& origins) {
  setNodeWords(value, kOriginExtension, kOriginArray, {origins.begin(), origins.end()});
}

std::vector<bool> readEditedWalls(const Case& value) {
  return readNodeWords<bool>(value, kEditedWallArray);
}

void setEditedWalls(Case& value, const std::vector<bool>& edited) {
  setNodeWords(value, kEditExtension, kEditedWallArray, {edited.begin(), edited.end()});
}

}  // namespace lumen::formats
