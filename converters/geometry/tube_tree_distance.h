// SPDX-License-Identifier: Apache-2.0
// The exact wall of a centerline tree taken as tubes.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box_tree.h"
#include "formats/case/case.h"

namespace lumen {

/// A round cone, the convex hull of two spheres: the volume swept by a sphere whose radius changes
/// linearly from `a` to `b`.
class RoundCone {
public:
  RoundCone(const Eigen::Vector3d& a, double radiusA, const Eigen::Vector3d& b, double radiusB);

  /// Signed distance to the surface, negative inside, in the unit of the input. Exact everywhere.
  /// `along` (may be null) becomes the position of the nearest sphere between a and b, in [0, 1].
  [[nodiscard]] double distance(const Eigen::Vector3d& point, double* along = nullptr) const;

private:
  Eigen::Vector3d m_a, m_axis;  // m_axis: unit, or zero if one sphere holds the other
  double m_length, m_radiusA, m_radiusB;
  double m_soleEnd = 0;                // `along` if one sphere holds the other
  double m_sine, m_cosine, m_tangent;  // functions of the cone's half angle, > 0 if it narrows to b
};

/// Position of a point with respect to the wall.
struct WallHit {
  double distance = std::numeric_limits<double>::infinity();  ///< mm, negative inside
  std::uint32_t branch = 0;                                   ///< branch of the nearest surface
  std::uint32_t node = 0;                                     ///< first node of the nearest segment
  double along = 0;  ///< fraction of the segment from `node` to the branch's next node, in [0, 1]
};

/// The union of the round cones between consecutive nodes of each branch (a sphere for a branch of
/// one node; no cone for the link to a parent node). Every end is round. Immutable, so safe to
/// query from any thread.
class TubeTreeDistance {
public:
  /// All branches of `tree`, which is not kept.
  explicit TubeTreeDistance(const formats::CenterlineTree& tree);
  /// Only the given branch.
  TubeTreeDistance(const formats::CenterlineTree& tree, std::uint32_t branch);

  /// Outside of the union the distance is exact. Inside it is the depth below the surface of the
  /// segment in which the point lies deepest: exact but within a crease between branches, where the
  /// union is deeper than that. The lowest node wins a tie. An empty tree is infinitely far away.
  [[nodiscard]] WallHit nearest(const Eigen::Vector3d& point) const;

  /// Replaces `segments` by those that may be nearest to some point within `reach` mm of `centre`,
  /// for many queries near one place: nearestAmong() with them equals nearest() there.
  void collect(const Eigen::Vector3d& centre, double reach,
               std::vector<std::uint32_t>& segments) const;
  [[nodiscard]] WallHit nearestAmong(std::span<const std::uint32_t> segments,
                                     const Eigen::Vector3d& point) const;

private:
  struct Segment {
    RoundCone cone;
    std::uint32_t branch, node;
  };
  using Tree = convert::BoxTree<double>;

  void lower(std::uint32_t segment, const Eigen::Vector3d& point, WallHit& hit) const;
  void addBranch(const formats::CenterlineTree& tree, std::uint32_t branch);
  void build(const formats::CenterlineTree& tree);
  [[nodiscard]] double leastDistance(std::uint32_t node, const Eigen::Vector3d& point) const;

  std::vector<Segment> m_segments;
  Tree m_tree;                      // hierarchy over the axes of the segments
  std::vector<double> m_maxRadius;  // maximum over the segments of each tree node
};

}  // namespace lumen
