// SPDX-License-Identifier: Apache-2.0
#include "formats/case/node_origin.h"

#include <cstdint>

#include "formats/case/node_words.h"

namespace lumen::formats {

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
