// SPDX-License-Identifier: Apache-2.0
#include "formats/case/edited_walls.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

namespace lumen::formats {
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
