// SPDX-License-Identifier: Apache-2.0
// The node of a point: by the bounding-volume hierarchy of blob_cursor_locate(), or by following.
#pragma once

#include <cstdint>
#include <vector>

#include "model.h"

namespace lumen::blob {

LocateTree buildLocateTree(const std::vector<NodeRecord>& nodes);

/// The place of each node in the leaves: kLanes times the leaf, plus the lane.
std::vector<std::uint32_t> findLeafSlots(const LocateTree& tree, std::size_t nodeCount);

/// Bounds a child of a level again: a leaf, for level 0, or else a block of the level before.
void refitChild(LocateTree& tree, std::size_t level, std::size_t child) noexcept;

/// The node of least power, the lowest index among equals. The point is finite.
std::uint32_t locateNode(const blob_model& model, const double* point) noexcept;

/// The node for a query at a finite point: the cursor, located if unknown, and followed unless
/// held.
std::uint32_t nodeFor(const blob_model& model, std::uint32_t flags, const double* point,
                      std::uint32_t cursor) noexcept;

/// Finds the node of a query, and moves the cursor, which may be null; false for a point that cannot be
/// evaluated.
bool findQueryNode(const blob_model& model, std::uint32_t flags, const double* point,
                   std::uint32_t* cursor, std::uint32_t& node) noexcept;

}  // namespace lumen::blob
