// SPDX-License-Identifier: Apache-2.0
// Place where an instrument enters a case, and the length that it can be pushed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "formats/case/case.h"

namespace lumen::convert {

struct Insertion {
  std::uint32_t branch = 0, node = 0;                    ///< indices in the tree
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< mm, LPS
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector, into the vessels
  double radius = 0;                                     ///< radius of the vessel there, mm
  double pathLength = 0;  ///< mm, along the widest branches, to a radius before the last one's end
  /// Nodes from the branch's first one along the widest branches to the last one's end.
  std::vector<std::uint32_t> path;
};

/// The insertion at the beginning of the branch called `label`, or, if that is empty, of the first
/// vessel that is a root; so far in that no end of the vessel is within `clearance`, mm, of it.
/// Throws Error(Usage), with the labels that there are, for a label that no branch has, and
/// Error(InvalidInput) for a case without a tree and for a lumen that is narrower than `clearance`.
Insertion findInsertion(const formats::CenterlineTree& tree, const std::string& label,
                        double clearance);

/// Turns the x axis to `direction`, by the least angle.
Eigen::Quaterniond turnTo(const Eigen::Vector3d& direction);

}  // namespace lumen::convert
