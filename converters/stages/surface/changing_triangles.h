// SPDX-License-Identifier: Apache-2.0
// Triangles that are changed one by one, and whether another would run through them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/geometry/box_tree.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// A bounding-volume hierarchy of the triangles of a mesh that follows when triangles get other
/// corners or go. Vertices never move.
class ChangingTriangles {
public:
  /// The mesh has at least one triangle; triangles keep their indices.
  explicit ChangingTriangles(TriangleMesh mesh);

  void change(std::uint32_t triangle, const Triangle& corners);
  void remove(std::uint32_t triangle);

  /// Whether a triangle of the mesh's vertices would meet an existing one in more than the vertices
  /// or the edge that they share by index; triangles of `without` do not count.
  [[nodiscard]] bool meets(const Triangle& corners, std::span<const std::uint32_t> without) const;

  [[nodiscard]] const TriangleMesh& mesh() const { return m_mesh; }

private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  using Tree = BoxTree<double>;
  [[nodiscard]] Box3d boxAround(const Triangle& corners) const;
  [[nodiscard]] Box3d boxOfNode(std::uint32_t index) const;
  void refit(std::uint32_t leaf);

  TriangleMesh m_mesh;
  std::vector<bool> m_isRemoved;
  Tree m_tree;
  std::vector<std::uint32_t> m_parent;  // parent of each node of the tree
  std::vector<std::uint32_t> m_leafOf;  // leaf of each triangle
};

}  // namespace lumen::convert
