// SPDX-License-Identifier: Apache-2.0
// Queries of a triangle mesh: ray hits, nearest points, inside or outside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box_tree.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_block.h"
#include "converters/geometry/wide_box_tree.h"

namespace lumen::convert {

/// The hit of a ray on a mesh; lengths in the mesh's unit.
struct RayHit {
  double distance = 0;  ///< from the ray's origin
  std::uint32_t triangle = 0;
  bool leaves = false;  ///< the ray hits the triangle from behind, out of the enclosed volume
};

struct NearestPoint {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// A bounding-volume hierarchy of the triangles of a mesh that computes in doubles and in one fixed
/// order: results have equal bits on every machine, unlike those of single-precision kernels that
/// depend on the instruction set. Immutable after construction, so safe to query from any thread.
class TriangleTree {
public:
  /// `mesh` has at least one triangle and must outlive this object.
  explicit TriangleTree(const TriangleMesh& mesh);

  /// The first triangle that the ray meets at `least`, 0 or more, or farther; `direction` is a unit vector. The
  /// lowest index wins where several lie in one place.
  [[nodiscard]] std::optional<RayHit> firstHit(const Eigen::Vector3d& origin,
                                               const Eigen::Vector3d& direction,
                                               double least = 0) const;
  /// Whether the straight segment between two points meets no triangle.
  [[nodiscard]] bool isFree(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  /// The nearest point of the mesh within `reach`; its distance is infinite if there is none.
  [[nodiscard]] NearestPoint nearest(const Eigen::Vector3d& point,
                                     double reach = std::numeric_limits<double>::infinity()) const;
  /// Calls visit(triangle, its nearest point, squared distance) for the triangles whose boxes are
  /// within the square root of `most`, which `visit` may lower, of the point: near ones first. Passes
  /// over a node of boxes() and all below it where enters(node, squared distance of its box) is
  /// false.
  template <class Visit, class Enters>
  void visitNear(const Eigen::Vector3d& point, const double& most, Visit&& visit,
                 const Enters& enters) const;
  [[nodiscard]] const BoxTree<float>& boxes() const { return m_tree; }
  /// Whether a closed mesh encloses the point: the majority of three rays, each by the number of
  /// exits less the number of entries.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;

  /// The unit normal of a triangle, outward; zero if it has no area.
  [[nodiscard]] Eigen::Vector3d normal(std::uint32_t triangle) const;
  [[nodiscard]] const TriangleMesh& mesh() const { return m_mesh; }

private:
  using Tree = BoxTree<float>;
  [[nodiscard]] static double squaredDistance(const Box3f& box, const Eigen::Vector3d& point);
  [[nodiscard]] int winding(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  [[nodiscard]] Eigen::Vector3d corner(std::uint32_t triangle, std::size_t i) const {
    return m_mesh.position[m_mesh.triangle[triangle][i]];
  }
  template <class Visit>
  void eachOnRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double least,
                 const double& most, Visit&& visit) const;

  const TriangleMesh& m_mesh;
  Tree m_tree;                         // boxes enclose their triangles
  WideBoxTree m_wide;                  // the same boxes, for rays and nearest points
  std::vector<TriangleBlock> m_block;  // of each leaf
};

template <class Visit, class Enters>
void TriangleTree::visitNear(const Eigen::Vector3d& point, const double& most, Visit&& visit,
                             const Enters& enters) const {
  std::array<std::uint32_t, Tree::kDeepest> stack{};
  std::size_t depth = 1;
  while (depth > 0) {
    const std::uint32_t i = stack[--depth];
    const Tree::Node& node = m_tree.node(i);
    const double apart = squaredDistance(node.box, point);
    if (apart > most || !enters(i, apart)) continue;
    if (node.count > 0) {
      for (std::uint32_t k = node.at; k < node.at + node.count; ++k) {
        const std::uint32_t t = m_tree.items()[k];
        const Eigen::Vector3d at =
            nearestPointOnTriangle(point, corner(t, 0), corner(t, 1), corner(t, 2));
        const double squared = (at - point).squaredNorm();
        if (squared <= most) visit(t, at, squared);
      }
      continue;
    }
    const bool oneFirst = squaredDistance(m_tree.node(i + 1).box, point) <=
                          squaredDistance(m_tree.node(node.at).box, point);
    stack[depth++] = oneFirst ? node.at : i + 1;
    stack[depth++] = oneFirst ? i + 1 : node.at;
  }
}

}  // namespace lumen::convert
