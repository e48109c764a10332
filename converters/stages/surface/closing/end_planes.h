// SPDX-License-Identifier: Apache-2.0
// The planes in which the vessels of a case end.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

/// A plane across a vessel at its end.
struct EndPlane {
  std::uint32_t branch = 0;  ///< index into the tree's branches
  std::uint32_t node = 0;    ///< the first or last node of the branch that has a model
  bool isInlet = false;      ///< before the first node of a root; else behind the last of a branch
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the plane, on the axis, mm
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, out of the vessel
  bool staysRound = false;                           ///< it is not to be cut
};

/// The distance of the plane behind the centre of a branch's last node, mm: half of the cylinder's
/// height, and no less than half a radius.
double reachOfEnd(const formats::CenterlineTree& tree, std::uint32_t node);

/// The end of a branch: at the flat end of its last node's cylinder, where its points end; beyond,
/// models flare and taper by a quarter of the radius within a third of a height. `last`: behind the
/// last node; else before the first. Nothing for an aneurysm, whose dome is wall that was seen,
/// before a branch that is joined to another, and where another node within two edges continues the
/// vessel within 60 degrees of its direction.
std::optional<EndPlane> freeEnd(const formats::Case& source, const formats::Neighbours& edges,
                                std::uint32_t branch, bool last);

/// The free ends of a case that has models, by branch, inlets first. A branch does not end where
/// another one is joined to its last node or a link ends there.
std::vector<EndPlane> endPlanes(const formats::Case& source);

/// The plane across the same vessel `distance` mm farther in, along its centerline. Nothing beyond
/// the other end of the branch.
std::optional<EndPlane> movedInward(const formats::Case& source, const EndPlane& plane,
                                    double distance);

/// The nodes of the branch whose distance along it from the plane's node is at most `reach` mm,
/// ascending.
std::vector<std::uint32_t> nodesNearEnd(const formats::Case& source, const EndPlane& plane,
                                        double reach);

}  // namespace lumen::convert
