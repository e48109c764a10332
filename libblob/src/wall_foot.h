// SPDX-License-Identifier: Apache-2.0
// The nearest points of the wall that a back end finds for a batch of points.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/field/vector.h"
#include "model.h"

namespace lumen::blob {

/// A unit vector along the vessel at a node; any for a node alone.
inline field::Vec alongVessel(const blob_model& model, std::uint32_t node) {
  const NodeRecord& record = model.nodes[node];
  if (record.neighbourBlocks > 0) {
    const NeighbourBlock& block = model.neighbours[record.firstNeighbours];
    const field::Vec towards{block.nx[0], block.ny[0], block.nz[0]};
    if (dot(towards, towards) > 0) return (1.0 / norm(towards)) * towards;
  }
  return {1, 0, 0};
}

/// Points that are refined together.
constexpr std::size_t kMostRefined = 128;

enum class FootState : std::uint8_t {
  None,  ///< no search was tried: the field vanishes at the point
  Best,  ///< the search is stuck: `at` is the best place about the wall
  Found  ///< `at` is the nearest point of the wall, `normal` the normal there
};

/// A point of the wall that is near a query point.
struct WallFoot {
  double at[3];     ///< mm
  float normal[3];  ///< outward; of `Found` alone
  std::uint32_t node;
  std::uint32_t steps;  ///< evaluations made, the query point's included
  FootState state;
};

/// Searches for the nearest points of the wall.
struct FootJob {
  std::size_t count;  ///< at most kMostRefined
  const double (*points)[3];
  const bool* inRange;         ///< of each point
  const blob_sample* samples;  ///< answers of f at the points
  WallFoot* feet;              ///< one for each point, `None` where it is out of range
};

}  // namespace lumen::blob
