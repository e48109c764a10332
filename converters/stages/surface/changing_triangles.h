// SPDX-License-Identifier: Apache-2.0
// Triangles that are changed one by one, and whether another would run through them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// A tree of boxes around the triangles of a mesh, which follows when triangles get other corners or
/// go. Vertices never move.
class ChangingTriangles {
public:
  /// The mesh has at least one triangle; triangles keep their indices.
  explicit ChangingTriangles(TriangleMesh mesh);

  void change(std::uint32_t triangle, const Triangle& corners);
  void remove(std::uint32_t triangle);

  /// Whether a triangle of the mesh's vertices would have more in common with one that is there than
  /// the vertices or the edge that they share by index; those of `without` do not count.
  [[nodiscard]] bool meets(const Triangle& corners, std::span<const std::uint32_t> without) const;

  [[nodiscard]] const TriangleMesh& mesh() const { return m_mesh; }

private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  // Children of box i are i + 1 and `right` (0: a leaf of triangles m_order[first, last)).
  struct Box {
    Eigen::Vector3d low, high;
    std::uint32_t first = 0, last = 0, right = 0, parent = kNone;
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t last, std::uint32_t parent,
                      const std::vector<Eigen::Vector3d>& centre);
  void fit(Box& box, std::uint32_t self) const;
  void refit(std::uint32_t leaf);

  TriangleMesh m_mesh;
  std::vector<bool> m_isRemoved;
  std::vector<Box> m_boxes;
  std::vector<std::uint32_t> m_order, m_leafOf;
};

}  // namespace lumen::convert
