// SPDX-License-Identifier: Apache-2.0
// The ends of a case's vessels, by the names that all files of a folder use.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
