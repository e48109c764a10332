// SPDX-License-Identifier: Apache-2.0
// Nodes that are carried to other places, by their poses.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "formats/case/case.h"

namespace lumen::convert {

Eigen::Quaterniond rotationOf(const formats::Pose& pose);
formats::Pose poseOf(const Eigen::Vector3d& centre, const Eigen::Quaterniond& rotation,
                     double factor);

/// A tree whose nodes are posed: centres, directions, radii and heights. `poses`: one for each node.
formats::CenterlineTree posedTree(const formats::CenterlineTree& rest,
                                  const std::vector<formats::Pose>& poses);

/// The tree and the wall points of a case at poses of its nodes; no models and no motion.
formats::Case posedWalls(const formats::Case& rest, const std::vector<formats::Pose>& poses);

/// The poses of all nodes of a tree that moves by centres alone: each turns by the least rotation that
/// leads from the direction of the vessel at rest to that of the centres (mm), each over a radius to both
/// sides; `factor` for each.
std::vector<formats::Pose> posesFromCentres(const formats::CenterlineTree& rest,
                                            const std::vector<Eigen::Vector3d>& centres,
                                            const std::vector<double>& factors);

}  // namespace lumen::convert
