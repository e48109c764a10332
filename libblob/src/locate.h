// SPDX-License-Identifier: Apache-2.0
// The node of a point: by the bounding-volume hierarchy of blob_cursor_locate(), or by following.
#pragma once

#include <cstdint>
#include <vector>

#include "model.h"

namespace lumen::blob {

LocateTree buildLocateTree(const std::vector<NodeRecord>& nodes);

/// The node of least power, the lowest index among equals. The point is finite.
std::uint32_t locateNode(const blob_model& model, const double* point) noexcept;

/// The node for a query at a finite point: the cursor, located if unknown, and followed unless
/// held.
std::uint32_t nodeFor(const blob_model& model, std::uint32_t flags, const double* point,
                      std::uint32_t cursor) noexcept;

}  // namespace lumen::blob
