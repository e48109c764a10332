// SPDX-License-Identifier: Apache-2.0
// Which part of a tree a tool can be pushed through: along every edge from the roots on, the
// blended field that its cursor answers must say that it is inside (docs/method.md, section 3.6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "formats/case/case.h"
#include "formats/field/blended_field.h"
#include "formats/field/vector.h"

namespace lumen::formats {

/// Where a point on its way along an edge is outside of the lumen.
struct ClosedPlace {
  std::uint32_t node = 0;    ///< the edge's farther end; a root whose own centre is outside
  field::Vec place{};        ///< mm, LPS
  std::uint32_t cursor = 0;  ///< the node that the point's cursor is at
};

/// Told of a place; answers whether it wants the next ones of the same edge.
using TellClosedPlace = std::function<bool(const ClosedPlace&)>;

/// Pushes a point from every root along every edge, in node order, and tells where it is outside. It
/// steps by at most an eighth of the edge's lesser radius, but 512 times at most. Its cursor follows
/// it from the root on; beyond a closed edge it is set anew at the node. Of a root, its centre is
/// asked. The case is valid and has models. `check`, if there is one, is called before each node and
/// may throw to end it all. O(n) for edges as long as radii.
void findClosedPlaces(const CenterlineTree& tree, const field::BlendedField& field,
                      const TellClosedPlace& tell, const std::function<void()>& check = {});

/// An edge, from a node's parent to the node, that no point can be pushed along.
struct Barrier {
  std::uint32_t node = 0;  ///< the edge's farther end; a root whose own centre is outside
  field::Vec place{};      ///< where the way first leaves the lumen, mm, LPS
  double beyond = 0;       ///< length of the tree that cannot be reached because of it, mm
};

/// Lengths are those of edgeLength(), mm.
struct Reachability {
  double total = 0;
  double reachable = 0;           ///< from all roots
  std::vector<Barrier> barriers;  ///< the first on each way from a root, in node order
};

/// What findClosedPlaces() says about each way from a root. Of an edge that is closed anywhere,
/// nothing is reachable. Needs and costs what that does.
Reachability reachabilityOf(const CenterlineTree& tree, const field::BlendedField& field,
                            const std::function<void()>& check = {});

}  // namespace lumen::formats
