// SPDX-License-Identifier: Apache-2.0
// Points that ride on the nodes of a case's tree, as the wall does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <blob_pose.h>
#include <sofa/defaulttype/VecTypes.h>

namespace lumensofa {

inline constexpr std::size_t kMostWeights = 24;  ///< libblob's: nodes that answer at a point

/// Points of a vessel at rest, each with the nodes that answer at it and their weights.
class PointsOnNodes {
public:
  using Coords = sofa::defaulttype::Vec3Types::VecCoord;

  PointsOnNodes() = default;
  /// `points`: mm, at rest; `flags`: those of libblob's queries.
  PointsOnNodes(const blob_model* rest, std::uint32_t flags, const Coords& points);

  [[nodiscard]] std::size_t size() const { return m_rest.size(); }
  /// Writes where the points are in a pose, mm; `moved` has their number.
  void move(const blob_pose* pose, Coords& moved);

private:
  /// Columns of the matrix that carries a point from where it is at rest.
  struct Carrier {
    sofa::type::Vec3 x, y, z, offset;
  };

  Coords m_rest;
  std::vector<std::size_t> m_first;  ///< of each point's entries in the next two; and their end
  std::vector<std::uint32_t> m_nodes;
  std::vector<double> m_weights;
  std::vector<sofa::type::Vec3> m_centres;  ///< mm, of the nodes at rest
  std::vector<Carrier> m_carriers;          ///< one for each node
};

}  // namespace lumensofa
