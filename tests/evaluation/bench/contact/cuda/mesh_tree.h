// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over the triangles of a mesh, as graphics processors search it: two boxes in a
// node, so that one load says which child to enter; T. Aila and S. Laine, Understanding the
// efficiency of ray traversal on GPUs, High Performance Graphics, 2009.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "method.h"
#include "signed_mesh.h"

namespace lumen::bench {

using Float4 = std::array<float, 4>;

struct MeshTree {
  /// Four of each node: x and y of the first child's box (low x, high x, low y, high y), those of the
  /// second, z of both (low, high, low, high), and the children as integers: a node, or
  /// ~(8 first + count) of a leaf's triangles.
  std::vector<Float4> node;
  std::vector<Float4> corner;  ///< three of each triangle, in the order of the leaves
  std::vector<Float4> normal;  ///< seven of each triangle: pseudonormals in the order of Feature

  /// Splits by the least surface area (I. Wald, On fast construction of SAH-based bounding volume
  /// hierarchies, IEEE Symposium on Interactive Ray Tracing, 2007); at most four triangles in a leaf.
  MeshTree(const Triangles& mesh, const SignedMesh& normals);
  [[nodiscard]] double megabytes() const;
};

}  // namespace lumen::bench
