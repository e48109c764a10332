// SPDX-License-Identifier: Apache-2.0
// A wall with a thickness, as a solid.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

// The outer surface of a wall: its distance from a lumen's surface is the wall's thickness.

/// The signed distance to the outer surface of a wall around a lumen.
///
/// With d the distance from the lumen's surface, t the thickness there, and d', t' those of another
/// vessel, the surface is the zero of
///
///     g = max(d - t, (d/t - d'/t') / (1/t + 1/t') + gap/2)
///
/// so walls of vessels that touch share the space between the lumens in proportion to their
/// thicknesses. Nodes belong to different vessels if their distance along the tree is longer than
/// six times the width of both with their walls. Nearer ones have one wall: it fills the corner of
/// a fork. With Touching::Share all vessels have one wall, whose surface is the zero of the least
/// d - t.
class OffsetField : public SeparatedField {
public:
  /// `inner` is a closed surface of the case, whose ends are cut; it must stay. Thicknesses in
  /// radii grow by no more than a quarter of the distance along the surface.
  OffsetField(const formats::Case& source, const field::BlendedField& field, double gap,
              const CaseSurface& inner, const Length& thickness,
              Touching touching = Touching::Apart);

  [[nodiscard]] SeparatedSample at(const Eigen::Vector3d& point, std::uint32_t node) const override;
  [[nodiscard]] SeparatedSample deepest(const Eigen::Vector3d& point,
                                        std::uint32_t node) const override;
  [[nodiscard]] bool isReached(const Eigen::Vector3d& point, std::uint32_t from,
                               std::uint32_t to) const override;
  /// The distance of a point from the lumen's surface, mm, for a cursor at `node`; negative inside.
  [[nodiscard]] double fromLumen(const Eigen::Vector3d& point, std::uint32_t node) const;

private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Foot {
    double distance = 0;  ///< from the lumen's surface, mm; negative inside
    double thickness = 0;
    std::uint32_t node = kNone;  ///< node of the tree; none if nothing is within reach
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< unit, of the distance
  };
  [[nodiscard]] bool isOther(std::uint32_t a, std::uint32_t b) const;
  /// The foot with the least d - t within `reach`, among those whose node `takes` accepts.
  template <class Takes>
  [[nodiscard]] Foot nearestFoot(const Eigen::Vector3d& point, double reach,
                                 const Takes& takes) const;
  [[nodiscard]] Foot ownFoot(const Eigen::Vector3d& point, std::uint32_t node) const;
  [[nodiscard]] Foot footOn(std::uint32_t triangle, const Eigen::Vector3d& at,
                            const Eigen::Vector3d& point) const;
  [[nodiscard]] SeparatedSample sampleFrom(const Eigen::Vector3d& point, const Foot& own) const;

  const CaseSurface& m_inner;
  TriangleTree m_tree;
  std::vector<double> m_thickness;        ///< thickness at each vertex
  std::vector<Eigen::Vector3d> m_normal;  ///< normal of each vertex, weighted by its faces' angles
  std::vector<double> m_thickestBelow;    ///< for each node of the boxes of m_tree
  double m_thickest = 0;
};

/// Joins a lumen's surface and one around it, cut by cutEnds() in the same planes, to the closed
/// surface of the wall between them: the lumen's is turned over, and at each flat end the two rims
/// are joined by a flat ring. Groups: "wall" is the lumen's side, then "outer-wall", then the ends,
/// whose rings keep the lumen's names; round ends belong to the walls, and have no group. Its Euler
/// characteristic is the sum of both less two for each flat end. Throws Error(Failed) if the two do
/// not have the same ends, or if rims are not one within the other.
CaseSurface thickWall(const CaseSurface& inner, const CaseSurface& outer);

/// Moves vertices of `outer`, which follows `field`, outwards where its triangles pass through the
/// lumen's, in steps of a tenth of the thickness, ten times at most; the rims of flat ends stay.
/// Throws Error(Cancelled).
void liftOuter(const CaseSurface& inner, CaseSurface& outer, const SeparatedField& field,
               const Progress& progress);

}  // namespace lumen::convert
