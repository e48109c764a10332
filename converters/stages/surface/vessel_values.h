// SPDX-License-Identifier: Apache-2.0
// Values of a tree at a place on the wall.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

struct VesselValues {
  float radius = 0;                 ///< mm
  std::optional<float> confidence;  ///< the inlier rate, in [0, 1]; nothing if the tree has none
};

/// The values of the nodes, linear along the edges of the tree that end in `node`, at the point of
/// these edges nearest to `point`, mm, LPS.
VesselValues vesselAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                      const Eigen::Vector3d& point, std::uint32_t node);

}  // namespace lumen::convert
