// SPDX-License-Identifier: Apache-2.0
#include "formats/case/node_origin.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "formats/case/enum_names.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {

namespace {

using Values = std::vector<std::uint32_t>;

bool isOrigins(const NodeArray& array) {
  return array.name == kOriginArray;
}

}  // namespace

std::optional<Issue> originFault(const NodeArray& array, const std::string& place) {
  if (!isOrigins(array)) return std::nullopt;
  if (array.components != 1)
    return limitIssue(ErrorCode::NodeArrayComponents, place + "/components", array.components, 1);
  const auto* values = std::get_if<Values>(&array.values);
  if (values == nullptr)
    return foundIssue(ErrorCode::EnumValue, place + "/type",
                      std::string(kArrayTypeNames[array.values.index()]), "u32");
  const auto fault = std::find_if(values->begin(), values->end(),
                                  [](std::uint32_t value) { return value >= kNodeOriginCount; });
  if (fault == values->end()) return std::nullopt;
  return foundIssue(
      ErrorCode::EnumValue,
      at("/nodeArrays/" + array.name, static_cast<std::size_t>(fault - values->begin())),
      std::to_string(*fault), "an origin from 0 to 2");
}

std::vector<NodeOrigin> readNodeOrigins(const Case& value) {
  std::vector<NodeOrigin> origins(value.tree.nodeCount(), NodeOrigin::Measured);
  const auto array = std::find_if(value.nodeArrays.begin(), value.nodeArrays.end(), isOrigins);
  if (array != value.nodeArrays.end())
    std::transform(std::get<Values>(array->values).begin(), std::get<Values>(array->values).end(),
                   origins.begin(), [](std::uint32_t v) { return static_cast<NodeOrigin>(v); });
  return origins;
}

void setNodeOrigins(Case& value, const std::vector<NodeOrigin>& origins) {
  auto& used = value.metadata.extensionsUsed;
  std::erase_if(value.nodeArrays, isOrigins);
  std::erase(used, kOriginExtension);
  std::erase(value.metadata.extensionsRequired, kOriginExtension);
  if (std::all_of(origins.begin(), origins.end(),
                  [](NodeOrigin origin) { return origin == NodeOrigin::Measured; }))
    return;
  Values values;
  for (const NodeOrigin origin : origins) values.push_back(static_cast<std::uint32_t>(origin));
  value.nodeArrays.push_back({kOriginArray, 1, "", std::move(values)});
  used.emplace_back(kOriginExtension);
}

namespace {

bool holdsEditedWalls(const NodeArray& array) {
  return array.name == kEditedWallArray;
}

}  // namespace

std::vector<bool> readEditedWalls(const Case& value) {
  std::vector<bool> edited(value.tree.nodeCount(), false);
  const auto array =
      std::find_if(value.nodeArrays.begin(), value.nodeArrays.end(), holdsEditedWalls);
  if (array == value.nodeArrays.end()) return edited;
  const auto* values = std::get_if<std::vector<std::uint32_t>>(&array->values);
  if (values == nullptr || values->size() != edited.size()) return edited;
  for (std::size_t i = 0; i < edited.size(); ++i) edited[i] = (*values)[i] != 0;
  return edited;
}

void setEditedWalls(Case& value, const std::vector<bool>& edited) {
  auto& used = value.metadata.extensionsUsed;
  std::erase_if(value.nodeArrays, holdsEditedWalls);
  std::erase(used, kEditExtension);
  if (std::find(edited.begin(), edited.end(), true) == edited.end()) return;
  value.nodeArrays.push_back(
      {kEditedWallArray, 1, "", std::vector<std::uint32_t>(edited.begin(), edited.end())});
  used.emplace_back(kEditExtension);
}

}  // namespace lumen::formats
