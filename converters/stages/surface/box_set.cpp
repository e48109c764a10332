// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/box_set.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lumen::convert {

Box3d boxOf(const TriangleMesh& mesh, const Triangle& triangle) {
  Box3d box;
  for (const std::uint32_t v : triangle) box.add(mesh.position[v]);
  return box;
}

BoxSet::BoxSet(std::vector<Box3d> boxes) : m_boxes(std::move(boxes)) {
  if (m_boxes.empty()) return;
  std::vector<Eigen::Vector3d> middles;
  middles.reserve(m_boxes.size());
  for (const Box3d& box : m_boxes) middles.push_back(box.middle());
  m_tree = BoxTree<double>(m_boxes, middles);
}

bool BoxSet::meets(const Box3d& box) const {
  if (m_boxes.empty()) return false;
  std::array<std::uint32_t, BoxTree<double>::kDeepest> stack{};
  std::size_t depth = 1;
  while (depth > 0) {
    const std::uint32_t i = stack[--depth];
    const auto& node = m_tree.node(i);
    if (!node.box.meets(box)) continue;
    if (node.count == 0) {
      stack[depth++] = node.at;
      stack[depth++] = i + 1;
      continue;
    }
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k)
      if (m_boxes[m_tree.items()[k]].meets(box)) return true;
  }
  return false;
}

}  // namespace lumen::convert
