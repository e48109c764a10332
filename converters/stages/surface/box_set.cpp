// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/box_set.h"

#include <cstdint>
#include <utility>

#include "converters/geometry/box_tree_walk.h"

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
  return anyItemNear(m_tree, box, [&](std::uint32_t i) { return m_boxes[i].meets(box); });
}

}  // namespace lumen::convert
