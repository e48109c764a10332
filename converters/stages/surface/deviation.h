// SPDX-License-Identifier: Apache-2.0
// The deviation of a surface that loses triangles from the original.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_tree.h"

namespace lumen::convert {

/// A face of a surface.
struct GroupedFace {
  std::uint32_t index = 0;
  Triangle corner{};
  std::uint32_t group = 0;
};

/// Keeps, for each face of a surface, the points of the original surface that lie at the face (R.
/// Klein, G. Liebich and W. Strasser, *Mesh reduction with error control*, 1996), and answers
/// whether replacing faces keeps the surface within a distance: these points from the new faces of
/// their group, and points of the new faces from the original surface.
class Deviation {
public:
  /// `original` must stay. `isFree`: for each group whether its points do not count, as those of
  /// flat ends, whose rims are the wall's too. `spacing` is the length of edges around each vertex.
  Deviation(const TriangleMesh& original, const std::vector<std::uint32_t>& group,
            std::vector<bool> isFree, const std::vector<double>& spacing);

  /// Whether `now` may replace the faces `before`; keep() then adopts that answer.
  [[nodiscard]] bool isWithin(double bound, std::span<const std::uint32_t> before,
                              std::span<const GroupedFace> now);
  void keep(std::span<const std::uint32_t> before);

private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::uint32_t group = 0, next = kNone;  ///< next: the face's next point
  };
  void add(std::uint32_t face, std::uint32_t group, const Eigen::Vector3d& position);
  [[nodiscard]] double distance(const Eigen::Vector3d& p, std::uint32_t triangle) const;
  [[nodiscard]] bool isEdgeNear(const NearestPoint& a, const Eigen::Vector3d& atA,
                                const NearestPoint& b, const Eigen::Vector3d& atB, double bound,
                                int depth) const;
  [[nodiscard]] bool isNear(const GroupedFace& face, double bound) const;

  const TriangleMesh& m_original;
  TriangleTree m_tree;
  std::vector<bool> m_isFree;
  const std::vector<double>& m_spacing;
  std::vector<Point> m_points;
  std::vector<std::uint32_t> m_first;  ///< point of each face
  /// New faces of points, by the last isWithin().
  std::vector<std::pair<std::uint32_t, std::uint32_t>> m_newFace;
};

/// The greatest distance, mm, between two surfaces, in both directions: at points of each three
/// times as dense as the shorter of both surfaces' edges there, without faces of groups of
/// `isFree`.
double distanceBetween(const TriangleMesh& one, const std::vector<std::uint32_t>& groupOfOne,
                       const TriangleMesh& other, const std::vector<std::uint32_t>& groupOfOther,
                       const std::vector<bool>& isFree);

}  // namespace lumen::convert
