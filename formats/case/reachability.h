// SPDX-License-Identifier: Apache-2.0
// The part of a tree that a tool can be pushed through: it is inside along every edge from the
// roots on, by the blended field that its cursor answers (docs/method.md, section 3.6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "formats/case/case.h"
#include "formats/field/blended_field.h"
#include "formats/field/vector.h"

namespace lumen::formats {

/// A place on an edge where the pushed point is outside of the lumen.
struct ClosedPlace {
  std::uint32_t node = 0;    ///< the edge's farther end; a root whose own centre is outside
  field::Vec place{};        ///< mm, LPS
  std::uint32_t cursor = 0;  ///< node of the point's cursor
};

/// Receives a closed place; returns whether it wants the next ones of the same edge.
using ReportClosedPlace = std::function<bool(const ClosedPlace&)>;

/// Pushes a point from every root along every edge, in node order, and reports where it is outside.
/// A step is at most a 32nd of the edge's lesser radius, but an edge has at most 512 steps. The
/// cursor follows the point from the root on; beyond a closed edge it is set anew at the node. A
/// root is tested at its centre. The case is valid and has models. `check`, if there is one, is
/// called before each node and may throw to end the search. O(n) for edges as long as radii.
void findClosedPlaces(const CenterlineTree& tree, const field::BlendedField& field,
                      const ReportClosedPlace& report, const std::function<void()>& check = {});

/// An edge, from a node's parent to the node, that no point can be pushed along.
struct Barrier {
  std::uint32_t node = 0;  ///< the edge's farther end; a root whose own centre is outside
  field::Vec place{};      ///< where the edge first leaves the lumen, mm, LPS
  double beyond = 0;       ///< length of the tree that cannot be reached because of it, mm
};

/// Lengths are those of edgeLength(), mm.
struct Reachability {
  double total = 0;
  double reachable = 0;           ///< from all roots
  std::vector<Barrier> barriers;  ///< the first on each path from a root, in node order
  /// Index into `barriers`, by node: the one between the node and its root; -1 where there is none.
  std::vector<std::int32_t> barrierOf;
};

/// Reachable lengths and barriers by findClosedPlaces(), whose conditions and cost apply. An edge
/// that is closed anywhere is not reachable at all.
Reachability measureReachability(const CenterlineTree& tree, const field::BlendedField& field,
                                 const std::function<void()>& check = {});

}  // namespace lumen::formats
