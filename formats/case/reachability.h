// SPDX-License-Identifier: Apache-2.0
// Which part of a tree a tool can be pushed through: along every edge from the roots on, the
// blended field that its cursor answers must say that it is inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/case/case.h"
#include "formats/field/blended_field.h"
#include "formats/field/vector.h"

namespace lumen::formats {

/// An edge, from a node's parent to the node, that no point can be pushed along.
struct Barrier {
  std::uint32_t node = 0;  ///< the edge's farther end; a root whose own centre is outside
  field::Vec place{};      ///< where the way first leaves the lumen, mm, LPS
  double beyond = 0;       ///< length of the tree that cannot be reached because of it, mm
};

/// Where a point on its way along an edge is outside of the lumen: its place, and the node that its
/// cursor is at.
struct ClosedPlace {
  field::Vec place{};  ///< mm, LPS
  std::uint32_t cursor = 0;
};

/// For every node, the places at which a point that is pushed along its edge is outside, in steps of
/// at most an eighth of the lesser radius; of a root, its centre. Its cursor has followed it from
/// the root on; beyond a closed edge it is set anew at the node.
std::vector<std::vector<ClosedPlace>> closedPlacesOf(const CenterlineTree& tree,
                                                     const field::BlendedField& field);

/// Lengths are those of edgeLength(), mm.
struct Reachability {
  double total = 0;
  double reachable = 0;           ///< from all roots
  std::vector<Barrier> barriers;  ///< the first on each way from a root, in node order
};

/// Pushes a point from every root along every edge, in steps of at most an eighth of the lesser
/// radius, with a cursor that follows it from node to node. An edge is open if the blended field
/// exceeds T at every step. The case is valid and has models. O(n).
Reachability reachabilityOf(const CenterlineTree& tree, const field::BlendedField& field);

}  // namespace lumen::formats
