// SPDX-License-Identifier: Apache-2.0
// Boxes in which something is the matter, few beside the triangles of a surface.
#pragma once

#include <vector>

#include "converters/geometry/box.h"
#include "converters/geometry/box_tree.h"
#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// The box of a triangle's corners.
Box3d boxOf(const TriangleMesh& mesh, const Triangle& triangle);

/// Boxes, and whether another one meets any of them. Any number of threads may ask.
class BoxSet {
public:
  explicit BoxSet(std::vector<Box3d> boxes);
  [[nodiscard]] bool isEmpty() const { return m_boxes.empty(); }
  [[nodiscard]] bool meets(const Box3d& box) const;

private:
  std::vector<Box3d> m_boxes;
  BoxTree<double> m_tree;
};

}  // namespace lumen::convert
