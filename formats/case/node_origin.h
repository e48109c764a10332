// SPDX-License-Identifier: Apache-2.0
// Origins of the nodes of a tree: the node array LUMEN_node.origin (spec/lumen.md, extensions).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// Values are stored in files: append only.
enum class NodeOrigin : std::uint8_t {
  Measured = 0,  ///< fitted to a volume or a mesh
  Bridged = 1,   ///< put between measured nodes where nothing could be measured
  Given = 2,     ///< taken from a centerline that states radii
};
constexpr std::size_t kNodeOriginCount = 3;

constexpr const char* kOriginExtension = "LUMEN_node";
constexpr const char* kOriginArray = "LUMEN_node.origin";

/// One value for each node of a valid case; all are measured if the case has no such array.
std::vector<NodeOrigin> readNodeOrigins(const Case& value);

/// Replaces the node array of a case by `origins`, one value for each node, and lists its
/// extension; removes both if all nodes are measured.
void setNodeOrigins(Case& value, const std::vector<NodeOrigin>& origins);

// Nodes whose wall was changed by hand: the node array LUMEN_edit.wall (spec/lumen.md, extensions).

constexpr const char* kEditExtension = "LUMEN_edit";
constexpr const char* kEditedWallArray = "LUMEN_edit.wall";

/// One value for each node: whether its wall points or its radius were changed by hand. None is in
/// a case without the array, or with one of another type.
std::vector<bool> readEditedWalls(const Case& value);

/// Replaces the node array of a case by `edited`, one value for each node, and lists its extension;
/// removes both if no node is edited.
void setEditedWalls(Case& value, const std::vector<bool>& edited);

}  // namespace lumen::formats
