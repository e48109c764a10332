// SPDX-License-Identifier: Apache-2.0
// Items of a tree of boxes that may meet a box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "converters/geometry/box_tree.h"

namespace lumen::convert {

/// Visits the items of the leaves whose boxes meet `box`, until visit(item) returns true; returns
/// whether it did. The items' own boxes are not compared. None of an empty tree.
template <class Scalar, class Visit>
bool anyItemNear(const BoxTree<Scalar>& tree, const Box<Scalar>& box, Visit&& visit) {
  if (tree.nodes().empty()) return false;
  std::array<std::uint32_t, BoxTree<Scalar>::kDeepest> stack{};
  std::size_t pending = 1;
  while (pending > 0) {
    const std::uint32_t at = stack[--pending];
    const auto& node = tree.node(at);
    if (!node.box.meets(box)) continue;
    if (node.count == 0) {
      stack[pending++] = node.at;
      stack[pending++] = at + 1;
      continue;
    }
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k)
      if (visit(tree.items()[k])) return true;
  }
  return false;
}

}  // namespace lumen::convert
