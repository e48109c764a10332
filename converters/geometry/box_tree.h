// SPDX-License-Identifier: Apache-2.0
// The bounding-volume hierarchy of the converters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box.h"

namespace lumen::convert {

/// A binary tree of boxes around items that are numbered from 0. Its shape depends on the items
/// alone. A node comes before its children, and its first child is the next node; so a loop from
/// the last node to the first one meets children before their parents.
template <class Scalar>
class BoxTree {
public:
  static constexpr std::uint32_t kLeafItems = 4;  ///< maximum per leaf
  static constexpr std::size_t kDeepest = 64;  ///< maximum number of pending nodes of a traversal

  struct Node {
    Box<Scalar> box;
    std::uint32_t at = 0;     ///< leaf: place of its first item in items(); otherwise second child
    std::uint32_t count = 0;  ///< items of a leaf; 0: the node has children
  };

  BoxTree() = default;
  /// Leaves hold consecutive items, for items whose neighbours in order are neighbours in space.
  explicit BoxTree(std::span<const Box<Scalar>> boxes);
  /// Splits the items at the median of their box centres, across the longest side of these centres'
  /// box.
  BoxTree(std::span<const Box<Scalar>> boxes, std::span<const Eigen::Vector3d> middles);

  [[nodiscard]] const std::vector<Node>& nodes() const { return m_nodes; }
  [[nodiscard]] const Node& node(std::uint32_t index) const { return m_nodes[index]; }
  /// The items; those of a leaf are adjacent.
  [[nodiscard]] const std::vector<std::uint32_t>& items() const { return m_items; }
  void setBox(std::uint32_t index, const Box<Scalar>& box) { m_nodes[index].box = box; }

private:
  template <class Split>
  std::uint32_t build(std::span<const Box<Scalar>> boxes, std::uint32_t first, std::uint32_t last,
                      const Split& split);

  std::vector<Node> m_nodes;
  std::vector<std::uint32_t> m_items;
};

extern template class BoxTree<float>;
extern template class BoxTree<double>;

// Items of a tree of boxes that may meet a box.

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
