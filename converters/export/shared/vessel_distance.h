// SPDX-License-Identifier: Apache-2.0
// The signed distance of a case at many points: the one source of every grid that lumen writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/geometry/box.h"
#include "converters/geometry/case_model.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A distance, and whose wall it is to.
struct WallDistance {
  float distance = 0;        ///< mm, negative in the lumen
  std::uint32_t branch = 0;  ///< index into the tree's branches, of the node that answered
};

/// The wall's outward normal at its nearest point, and the node that answered.
struct WallFoot {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::uint32_t node = 0;
};

/// Radii from a node within which its wall lies: beyond them, a branch is left to the nearest node's
/// answer.
inline constexpr double kReachRadii = 2;

/// Nodes of a tree that a query may begin at, ascending.
using TreeRegion = std::vector<std::uint32_t>;

/// The branch's nodes, and those that are at most four radii from them along the tree, the greatest
/// distance over which nodes may blend (blob_model_neighbours()).
TreeRegion regionOfBranch(const formats::CenterlineTree& tree, std::uint32_t branch);

/// Answers of libblob. Places are in mm, LPS. Any number of threads may ask.
class VesselDistance {
public:
  /// The distance outside of the lumen is to the nearest point of the wall: libblob's
  /// one-evaluation form may be many millimetres short there. In the lumen it is that of this form
  /// (blob.h), which has no kink at the axis, or with `exact` to the nearest point as well. Throws
  /// Error(InvalidInput) for a case whose models libblob refuses.
  explicit VesselDistance(const formats::Case& source, bool exact = false);

  /// The distance to all vessels together, which one grid can hold: the nearest node answers, and
  /// every branch within whose doubled radius a point lies; the least counts. `points` are near
  /// each other, such as a part of a grid's row; `answers` has one entry for each. A distance
  /// beyond `band`, mm, may be answered by the band. `feet`
  /// is empty, or has one entry for each point, which is left as it was beyond the band.
  void ofAll(std::span<const Eigen::Vector3d> points, double band, std::span<WallDistance> answers,
             std::span<WallFoot> feet = {}) const;

  /// The distance to one part of the tree: from its node of least power a cursor follows the tree,
  /// so vessels that merely touch do not count.
  void ofRegion(const TreeRegion& region, std::span<const Eigen::Vector3d> points, double band,
                std::span<WallDistance> answers, std::span<WallFoot> feet = {}) const;

  [[nodiscard]] const blob_model& model() const { return *m_model; }
  [[nodiscard]] const formats::CenterlineTree& tree() const { return m_tree; }

private:
  void query(std::span<const Eigen::Vector3d> points, std::uint32_t* cursors,
             std::span<WallDistance> answers, std::span<WallFoot> feet) const;
  /// Answers for points[chosen[k]] from the nodes cursors[k]; kept where less.
  void takeLess(std::span<const Eigen::Vector3d> points, const std::vector<std::size_t>& chosen,
                std::vector<std::uint32_t>& cursors, std::span<WallDistance> answers,
                std::span<WallFoot> feet) const;
  void askBranch(std::uint32_t branch, std::span<const Eigen::Vector3d> points, const Box3d& box,
                 std::span<WallDistance> answers, std::span<WallFoot> feet) const;
  /// Whether a wall of the branch may be within `band` of the box.
  [[nodiscard]] bool hasNodeNear(std::uint32_t branch, const Box3d& box, double band) const;
  [[nodiscard]] double power(std::uint32_t node, const Eigen::Vector3d& p) const;

  const formats::CenterlineTree& m_tree;
  OwnedModel m_model;
  std::uint32_t m_flags;
  std::vector<Box3d> m_reach;  ///< each branch's box of its nodes' balls of twice the radius
};

}  // namespace lumen::convert
