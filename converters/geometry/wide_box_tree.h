// SPDX-License-Identifier: Apache-2.0
// A bounding-volume hierarchy of eight boxes a node, which rays and points are tested against at once.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box_tree.h"

namespace lumen::convert {

/// Eight boxes as a structure of arrays. Unused boxes are empty: no ray meets them, and they are
/// infinitely far from every point.
struct WideNode {
  static constexpr std::size_t kWidth = 8;
  using Keys = std::array<double, kWidth>;
  std::array<std::array<float, kWidth>, 6> plane;  ///< low x, high x, low y ..., then by box
  std::array<std::uint32_t, kWidth> at{};          ///< a node, or the number of a leaf
  std::uint32_t leaves = 0;                        ///< bits of the boxes that are leaves
};

/// A ray, prepared for tests against boxes.
class BoxRay {
public:
  BoxRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);
  /// Bits of the boxes that the ray enters at `most` or nearer, and the distances at which it does. Exact
  /// to rounding errors, which are smaller than the margins of a TriangleTree's boxes.
  std::uint32_t entries(const WideNode& node, double most, WideNode::Keys& out) const;

private:
  std::array<double, 3> m_origin{}, m_inverse{};
  std::array<std::uint32_t, 3> m_near{};  // planes that the ray meets first
};

/// Bits of the boxes whose squared distance from a point is at most `most`, and these distances.
std::uint32_t boxesNear(const WideNode& node, const Eigen::Vector3d& point, double most,
                        WideNode::Keys& out);

/// The boxes of a BoxTree, three of its levels in each node. Its leaves keep their items and get
/// numbers in the order of these.
class WideBoxTree {
public:
  WideBoxTree() = default;
  explicit WideBoxTree(const BoxTree<float>& tree);
  /// The first item of each leaf, in the order of BoxTree::items(), and behind them the number of all items.
  [[nodiscard]] std::span<const std::uint32_t> leaves() const { return m_leaf; }

  /// Calls leaf(number of a leaf) for the leaves whose key is at most `most`, which `leaf` may
  /// lower, those of lower keys first. keys(node, most, out) gives the bits of a node's boxes whose
  /// keys are at most `most`, and these keys; that of a box is no greater than those within it.
  template <class Keys, class Leaf>
  void visit(const double& most, const Keys& keys, const Leaf& leaf) const;

private:
  static constexpr std::size_t kPending = BoxTree<float>::kDeepest * (WideNode::kWidth - 1);
  void build(const BoxTree<float>& tree, std::uint32_t from, std::uint32_t self);

  std::vector<WideNode> m_nodes;
  std::vector<std::uint32_t> m_leaf;
};

template <class Keys, class Leaf>
void WideBoxTree::visit(const double& most, const Keys& keys, const Leaf& leaf) const {
  struct Waiting {
    double key;
    std::uint32_t at, isLeaf;
  };
  std::array<Waiting, kPending> stack;
  stack[0] = {0, 0, 0};
  std::size_t depth = m_nodes.empty() ? 0 : 1;
  WideNode::Keys key;
  while (depth > 0) {
    const Waiting here = stack[--depth];
    if (here.key > most) continue;
    if (here.isLeaf != 0) {
      leaf(here.at);
      continue;
    }
    const WideNode& node = m_nodes[here.at];
    const std::size_t bottom = depth;
    for (std::uint32_t bits = keys(node, most, key); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(bits));
      // the lowest key last, so that it is visited first
      std::size_t place = depth++;
      for (; place > bottom && stack[place - 1].key < key[k]; --place)
        stack[place] = stack[place - 1];
      stack[place] = {key[k], node.at[k], node.leaves >> k & 1U};
    }
  }
}

}  // namespace lumen::convert
