// SPDX-License-Identifier: Apache-2.0
// The neck and the dome of a sac in a field.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"
#include "converters/judge/measure/local_surface.h"
#include "converters/judge/measure/neck_plane.h"

namespace lumen::convert {

// The dome of a sac: the part of the wall beyond its neck plane.

/// The wall beyond a plane, open at its rim.
struct DomeSurface {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3d> rim;  ///< counter-clockwise seen from the dome, mm
};

/// Nothing if the plane does not separate the sac, or its rim is not one loop.
std::optional<DomeSurface> cutDome(PlaneCutter& cutter, const NeckPlane& plane);

/// The mean diameter of a section is twice the mean distance of its rim from its centroid (S. Dhar
/// et al., 2008).
struct DomeShape {
  Eigen::Vector3d neckCentre = Eigen::Vector3d::Zero();  ///< centroid of the neck's section, mm
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();         ///< farthest place from the neck's centre
  double neckArea = 0;                                   ///< mm^2
  double neckDiameter = 0;                               ///< mean diameter, mm
  double height = 0;      ///< greatest distance from the neck plane, mm
  double reach = 0;       ///< of the tip from the neck's centre, mm
  double width = 0;       ///< greatest mean diameter of sections parallel to the neck, mm
  double volume = 0;      ///< mm^3
  double area = 0;        ///< mm^2, without the neck's section
  double hullVolume = 0;  ///< mm^3, of the convex hull of the dome
  double hullArea = 0;    ///< mm^2, of that hull without its face in the neck plane
};

DomeShape shapeOf(const DomeSurface& dome, const NeckPlane& plane);

/// The shape with the volumes and areas for triangles of no size, out of those for triangles of some
/// edge and of half of it: errors of a mesh whose vertices lie on the surface go with the square of
/// the edge.
DomeShape extrapolated(const DomeShape& coarse, const DomeShape& fine);

/// `shape` with the difference of the volumes and areas of `to` and `from` added.
DomeShape corrected(const DomeShape& shape, const DomeShape& from, const DomeShape& to);

struct SacShape {
  NeckPlane neck;
  DomeSurface dome;
  DomeShape shape;  ///< for triangles of no size
  DomeShape moved;  ///< if the neck were `shift` farther out
};

/// Nothing if no plane separates the sac. `radius`: of a ball in the sac, whose centre is `seed`, mm;
/// triangles are a twentieth of it. `shift`: mm.
std::optional<SacShape> findSacShape(const BoxedField& field, const NeckPlace& place,
                                     const Eigen::Vector3d& seed, double radius, double shift,
                                     const Progress& progress);

}  // namespace lumen::convert
