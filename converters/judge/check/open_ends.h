// SPDX-License-Identifier: Apache-2.0
// Ends of branches of a case, and whether the volume shows that the vessel continues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/check/places.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The first node of a root or the last one of a branch, where nothing of the case is joined to it.
struct OpenEnd {
  std::uint32_t node = 0;
  bool first = false;                                 ///< the branch begins here
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit, along the vessel
  double goesOn = 0;                                  ///< mm of visible vessel beyond it; 0 if none
  std::optional<std::size_t> vessel;  ///< number of the missing vessel that goes on the farthest
};

/// The open ends of all vessels, branch by branch. An end continues in a missing vessel that comes
/// within two radii and three voxels of the node, ahead of it, with its own tip or the place where
/// it was reached from that branch; that vessel gets `atEnd`.
std::vector<OpenEnd> findOpenEnds(const formats::CenterlineTree& tree, double voxel,
                                  std::vector<MissingVessel>& vessels);

}  // namespace lumen::convert
