// SPDX-License-Identifier: Apache-2.0
// Place where an instrument enters a case, and the length that it can be pushed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/field_word.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

// The ends of a case's vessels, by the names that all files of a folder use.

/// Beginning or end of a vessel.
struct NamedEnd {
  std::string name;  ///< its group of faces: "inlet", "inlet-LABEL", "outlet-LABEL", "cap-LABEL"
  FaceKind kind = FaceKind::Outlet;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< mm, LPS: the middle of the opening
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit, LPS, out of the vessel
  double radius = 0;                                     ///< mm, of the circle of the same area
};

/// One for each group of faces but walls, in their order, measured on the edges that it shares with
/// the lumen's wall, which is group 0. `mesh`: mm, LPS, closed, of closedSurface(), with a thick
/// wall or without.
std::vector<NamedEnd> findEnds(const SurfaceMesh& mesh);

/// The ends that the tree alone states: an inlet at the first node of each root that is a vessel,
/// an outlet at the last node of each vessel to which no other is connected and that no link holds;
/// named as on the surface. Directions are the nodes', radii too.
std::vector<NamedEnd> findEnds(const formats::CenterlineTree& tree);

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
/// The label is the field "insert", the clearance comes of the field "instrument".
Insertion findInsertion(const formats::CenterlineTree& tree, const std::string& label,
                        double clearance, const FieldWord& word = {});

/// Turns the x axis to `direction`, by the least angle.
Eigen::Quaterniond turnTo(const Eigen::Vector3d& direction);

}  // namespace lumen::convert
