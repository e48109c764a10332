// SPDX-License-Identifier: Apache-2.0
#include "formats/case/node_origin.h"

#include <algorithm>

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

}  // namespace lumen::formats
