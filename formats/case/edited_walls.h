// SPDX-License-Identifier: Apache-2.0
// Nodes whose wall was changed by hand: the node array LUMEN_edit.wall (spec/lumen.md, extensions).
#pragma once

#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

constexpr const char* kEditExtension = "LUMEN_edit";
constexpr const char* kEditedWallArray = "LUMEN_edit.wall";

/// One value for each node: whether its wall points or its radius were changed by hand. None is in
/// a case without the array, or with one of another type.
std::vector<bool> readEditedWalls(const Case& value);

/// Replaces the node array of a case by `edited`, one value for each node, and lists its extension;
/// removes both if no node is edited.
void setEditedWalls(Case& value, const std::vector<bool>& edited);

}  // namespace lumen::formats
