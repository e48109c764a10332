// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/changing_triangles.h"

#include <algorithm>
#include <array>
#include <utility>

#include "converters/geometry/self_intersections.h"

namespace lumen::convert {

ChangingTriangles::ChangingTriangles(TriangleMesh mesh)
    : m_mesh(std::move(mesh)),
      m_isRemoved(m_mesh.triangle.size(), false),
      m_leafOf(m_mesh.triangle.size()) {
  std::vector<Box3d> boxes;
  std::vector<Eigen::Vector3d> centre;
  for (const Triangle& t : m_mesh.triangle) {
    boxes.push_back(boxAround(t));
    centre.emplace_back((m_mesh.position[t[0]] + m_mesh.position[t[1]] + m_mesh.position[t[2]]) /
                        3);
  }
  m_tree = Tree(boxes, centre);
  m_parent.assign(m_tree.nodes().size(), kNone);
  for (std::uint32_t i = 0; i < m_parent.size(); ++i) {
    const Tree::Node& node = m_tree.node(i);
    if (node.count == 0) m_parent[i + 1] = m_parent[node.at] = i;
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k) m_leafOf[m_tree.items()[k]] = i;
  }
}

Box3d ChangingTriangles::boxAround(const Triangle& corners) const {
  Box3d box;
  for (const std::uint32_t v : corners) box.add(m_mesh.position[v]);
  return box;
}

Box3d ChangingTriangles::boxOfNode(std::uint32_t index) const {
  const Tree::Node& node = m_tree.node(index);
  Box3d box;
  if (node.count == 0) {
    box.add(m_tree.node(index + 1).box);
    box.add(m_tree.node(node.at).box);
  }
  for (std::uint32_t k = node.at; k < node.at + node.count; ++k) {
    const std::uint32_t t = m_tree.items()[k];
    if (!m_isRemoved[t]) box.add(boxAround(m_mesh.triangle[t]));
  }
  return box;
}

void ChangingTriangles::refit(std::uint32_t leaf) {
  for (std::uint32_t i = leaf; i != kNone; i = m_parent[i]) {
    const Box3d box = boxOfNode(i);
    if (box == m_tree.node(i).box) return;
    m_tree.setBox(i, box);
  }
}

void ChangingTriangles::change(std::uint32_t triangle, const Triangle& corners) {
  m_mesh.triangle[triangle] = corners;
  refit(m_leafOf[triangle]);
}

void ChangingTriangles::remove(std::uint32_t triangle) {
  m_isRemoved[triangle] = true;
  refit(m_leafOf[triangle]);
}

bool ChangingTriangles::meets(const Triangle& corners,
                              std::span<const std::uint32_t> without) const {
  const Box3d around = boxAround(corners);
  std::array<std::uint32_t, Tree::kDeepest> stack{};
  std::size_t depth = 1;
  while (depth > 0) {
    const std::uint32_t i = stack[--depth];
    const Tree::Node& node = m_tree.node(i);
    if (!node.box.meets(around)) continue;
    if (node.count == 0) {
      stack[depth++] = node.at;
      stack[depth++] = i + 1;
      continue;
    }
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k) {
      const std::uint32_t t = m_tree.items()[k];
      if (m_isRemoved[t] || std::find(without.begin(), without.end(), t) != without.end()) continue;
      if (intersect(m_mesh, corners, m_mesh.triangle[t])) return true;
    }
  }
  return false;
}

}  // namespace lumen::convert
