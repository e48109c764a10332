// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/box_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace lumen::convert {

template <class Scalar>
BoxTree<Scalar>::BoxTree(std::span<const Box<Scalar>> boxes) : m_items(boxes.size()) {
  std::iota(m_items.begin(), m_items.end(), 0U);
  if (boxes.empty()) return;
  m_nodes.reserve(boxes.size() / 2 + 1);
  // all leaves but the last one are full
  const auto split = [](std::uint32_t first, std::uint32_t last) {
    return first + kLeafItems * std::bit_floor((last - first - 1) / kLeafItems);
  };
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()), split);
}

template <class Scalar>
BoxTree<Scalar>::BoxTree(std::span<const Box<Scalar>> boxes,
                         std::span<const Eigen::Vector3d> middles)
    : m_items(boxes.size()) {
  std::iota(m_items.begin(), m_items.end(), 0U);
  if (boxes.empty()) return;
  m_nodes.reserve(boxes.size());
  const auto split = [&](std::uint32_t first, std::uint32_t last) {
    Box3d around;
    for (std::uint32_t k = first; k < last; ++k) around.add(middles[m_items[k]]);
    Eigen::Index axis = 0;
    around.size().maxCoeff(&axis);
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(m_items.begin() + first, m_items.begin() + middle, m_items.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double at = middles[a][axis], other = middles[b][axis];
                       return at < other || (at == other && a < b);
                     });
    return middle;
  };
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()), split);
}

template <class Scalar>
template <class Split>
std::uint32_t BoxTree<Scalar>::build(std::span<const Box<Scalar>> boxes, std::uint32_t first,
                                     std::uint32_t last, const Split& split) {
  const auto self = static_cast<std::uint32_t>(m_nodes.size());
  m_nodes.emplace_back();
  if (last - first <= kLeafItems) {
    Node& leaf = m_nodes[self];
    leaf.at = first;
    leaf.count = last - first;
    for (std::uint32_t k = first; k < last; ++k) leaf.box.add(boxes[m_items[k]]);
    return self;
  }
  const std::uint32_t middle = split(first, last);
  build(boxes, first, middle, split);
  const std::uint32_t second = build(boxes, middle, last, split);
  Node& node = m_nodes[self];
  node.at = second;
  node.box = m_nodes[self + 1].box;
  node.box.add(m_nodes[second].box);
  return self;
}

template class BoxTree<float>;
template class BoxTree<double>;

}  // namespace lumen::convert
