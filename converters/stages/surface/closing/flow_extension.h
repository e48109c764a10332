// SPDX-License-Identifier: Apache-2.0
// Straight tubes in front of inlets and behind outlets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/closing/flat_region.h"
#include "converters/stages/surface/surface_fans.h"
#include "converters/stages/surface/surface_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

// The shape of a tube that continues a vessel from an opening.

/// An opening and the data of its tube. `place` of row 0 is the rim itself.
class FlowTube {
public:
  /// `rim` runs counter-clockwise seen from outside; the faces of the end are there.
  FlowTube(const SurfaceFans& fans, const SurfaceEnd& end, const std::vector<std::uint32_t>& rim);

  /// Radius of the circle of the opening's area, mm.
  [[nodiscard]] double radius() const { return m_radius; }
  /// Mean edge of the rim, mm.
  [[nodiscard]] double edge() const { return m_length / double(m_point.size()); }
  /// Number of vertices around the tube.
  [[nodiscard]] std::size_t around() const { return m_point.size(); }
  /// Rows of nearly equilateral triangles that a tube of this length, mm, needs.
  [[nodiscard]] std::size_t rows(double length) const;

  /// Vertex k of row j of `rows` of a tube of `length` mm; rows are staggered by half an edge.
  [[nodiscard]] Eigen::Vector3d place(std::size_t j, std::size_t k, std::size_t rows,
                                      double length) const;

  /// Coordinates in the plane of the opening, and back, `height` mm in front of it.
  [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d lift(const Eigen::Vector2d& p, double height) const;

private:
  [[nodiscard]] Eigen::Vector3d slopeAt(const SurfaceFans& fans,
                                        const std::vector<std::uint32_t>& rim, std::size_t i) const;
  void smoothSlopes();
  [[nodiscard]] double measureTurn(const Loop2& loop) const;
  [[nodiscard]] double indexAt(double around) const;

  SurfaceEnd m_end;
  Eigen::Vector3d m_along, m_across;
  std::vector<Eigen::Vector3d> m_point;  ///< positions of the rim's vertices
  std::vector<Eigen::Vector3d> m_slope;  ///< sideways for each mm along the normal, at each of them
  std::vector<double> m_share;           ///< rim length at each as a share, times their number
  double m_length = 0, m_radius = 0, m_turn = 0;
  Eigen::Vector2d m_centre = Eigen::Vector2d::Zero();
};

/// Extends flat ends by tubes along their normals. A length in radii refers to those of the
/// opening, the radius of the circle of its area. Within 1.5 radii of the rim the section changes
/// into this circle, on a Hermite curve that leaves along the wall's tangent there; then the tube
/// is straight. Sides belong to group 0, and the end's flat faces close the tube; their triangles
/// have edges about as long as the rim's. `ends` of the surface move along. Returns a sentence for
/// each tube that runs into the surface or another tube, and for each length whose branch has no
/// flat end. Throws Error(Usage) if a label is not in the case or comes twice, Error(InvalidInput)
/// if a tube needs more triangles than fit.
std::vector<std::string> extendEnds(CaseSurface& surface, const formats::Case& source,
                                    const std::vector<EndLength>& lengths);

/// Extends all flat ends by one length, but those whose tube would run into the surface or into
/// another tube: these stay as they are.
void extendFreeEnds(CaseSurface& surface, const formats::Case& source, const Length& length);

}  // namespace lumen::convert
