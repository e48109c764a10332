// SPDX-License-Identifier: Apache-2.0
// The part of space in which a node draws the wall.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "converters/stages/surface/patches/patch.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

/// The part of space in which a node draws the surface: the intersection of these half-spaces.
struct NodeCell {
  std::vector<HalfSpace> radical;  ///< its power cell
  std::vector<HalfSpace> ends;     ///< where the vessel is cut open
};

/// The cell of `node`. Nothing if it is empty.
///
/// Its power cell is bounded by the radical planes (equal power |X - O|^2 - r^2) to its neighbours,
/// as the blended field has them, that have a model: it is where following a point ends at the
/// node.
///
/// The cell is cut flat at free ends (end_planes.h).
std::optional<NodeCell> nodeCell(const formats::Case& source, const formats::Neighbours& edges,
                                 std::span<const std::uint32_t> neighbours, std::uint32_t node);

}  // namespace lumen::convert
