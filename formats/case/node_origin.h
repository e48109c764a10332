// SPDX-License-Identifier: Apache-2.0
// Where the nodes of a tree come from: the node array LUMEN_node.origin (spec/lumen.md, extensions).
#pragma once

#include <cstdint>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// Values are stored in files: append only.
enum class NodeOrigin : std::uint8_t {
  Measured = 0,  ///< fitted to a volume or a mesh
  Bridged = 1,   ///< put between measured nodes where nothing could be measured
  Given = 2,     ///< taken from a centerline with radii
};

constexpr const char* kOriginExtension = "LUMEN_node";
constexpr const char* kOriginArray = "LUMEN_node.origin";

/// One value for each node; all measured if the case does not say, or says what is not known here.
std::vector<NodeOrigin> nodeOriginsOf(const Case& value);

/// Replaces the array; without one if all nodes are measured. One value for each node.
void setNodeOrigins(Case& value, const std::vector<NodeOrigin>& origins);

}  // namespace lumen::formats
