// SPDX-License-Identifier: Apache-2.0
// The part of space in which a node draws the wall.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "converters/surface/patch.h"
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
/// A free end of a vessel (before the first node of a root branch, after the last node of any) is
/// cut at the flat end of the node's cylinder, where its points end: beyond, models flare and taper
/// by a quarter of the radius within a third of a height. Half a radius is always kept. An
/// aneurysm's dome is wall that was seen and stays whole, and so does an end that another node
/// continues.
std::optional<NodeCell> nodeCell(const formats::Case& source, const formats::Neighbours& edges,
                                 std::span<const std::uint32_t> neighbours, std::uint32_t node);

}  // namespace lumen::convert
