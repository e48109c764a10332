// SPDX-License-Identifier: Apache-2.0
#include "formats/case/node_origin.h"

#include <algorithm>

namespace lumen::formats {

std::vector<NodeOrigin> nodeOriginsOf(const Case& value) {
  std::vector<NodeOrigin> origins(value.tree.nodeCount(), NodeOrigin::Measured);
  for (const NodeArray& array : value.nodeArrays) {
    if (array.name != kOriginArray || array.components != 1) continue;
    const auto* stored = std::get_if<std::vector<std::uint32_t>>(&array.values);
    if (stored == nullptr || stored->size() != origins.size()) continue;
    for (std::size_t i = 0; i < origins.size(); ++i)
      if ((*stored)[i] <= static_cast<std::uint32_t>(NodeOrigin::Given))
        origins[i] = static_cast<NodeOrigin>((*stored)[i]);
  }
  return origins;
}

void setNodeOrigins(Case& value, const std::vector<NodeOrigin>& origins) {
  std::erase_if(value.nodeArrays, [](const NodeArray& a) { return a.name == kOriginArray; });
  if (std::all_of(origins.begin(), origins.end(),
                  [](NodeOrigin o) { return o == NodeOrigin::Measured; }))
    return;
  NodeArray array{kOriginArray, 1, "", std::vector<std::uint32_t>{}};
  auto& stored = std::get<std::vector<std::uint32_t>>(array.values);
  for (const NodeOrigin origin : origins) stored.push_back(static_cast<std::uint32_t>(origin));
  value.nodeArrays.push_back(std::move(array));
  auto& used = value.metadata.extensionsUsed;
  if (std::find(used.begin(), used.end(), kOriginExtension) == used.end())
    used.emplace_back(kOriginExtension);
}

}  // namespace lumen::formats
