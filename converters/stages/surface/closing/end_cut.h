// SPDX-License-Identifier: Apache-2.0
// The cut of one end of a surface by one plane, before it is done.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/surface/closing/end_planes.h"
#include "converters/stages/surface/closing/flat_region.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_fans.h"

namespace lumen::convert {

/// A cut that is possible. Vertex numbers from the surface's count on refer to `fresh`.
struct EndCut {
  struct Vertex {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::uint32_t node = 0;
  };
  std::vector<std::uint32_t> removed;  ///< triangles
  std::vector<Triangle> kept;          ///< the remains of those that the plane cuts
  std::vector<Vertex> fresh;
  std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> moved;  ///< vertices onto the plane
  std::vector<std::uint32_t> rim;  ///< vertices around the opening, counter-clockwise from outside
  Loop2 loop;                      ///< the rim in the coordinates of planeBasis(normal)
  FlatMesh cap;                    ///< its points are the rim's, then new ones
};

/// The reason why a plane cannot cut an end.
enum class NoCut : std::uint8_t {
  Before,  ///< the surface closes before the plane
  Other,   ///< another vessel, or another part of this one, begins behind the plane
  Handle,  ///< the part behind the plane is no disc
  Crooked  ///< the rim would cross itself
};

/// The cut of the end of `plane`'s branch: of the connected part beyond the plane at whose vertices
/// cursors are at `nodes` of the end, the one nearest to the axis. Vertices within a quarter of an
/// edge of the plane are moved into it, edges that cross it are split there, and both lie on the
/// field's surface where that is near. The surface stays a manifold of the same genus.
std::variant<EndCut, NoCut> planCut(const SurfaceFans& fans, const SeparatedField& field,
                                    const EndPlane& plane, const std::vector<std::uint32_t>& nodes,
                                    const std::vector<std::uint32_t>& candidates);

/// Applies a cut to its surface, which is unchanged since; the cap's triangles get `group`.
void applyCut(SurfaceFans& fans, const EndPlane& plane, const EndCut& cut, std::uint32_t group);

/// The vertices of one connected part of the surface beyond the plane, ascending: the part with the
/// one of `candidates` beyond it that is nearest to the axis. Vertices at nodes other than `nodes`
/// (ascending) are left out, and `leaves` reports whether there are any.
std::vector<std::uint32_t> partBeyond(const SurfaceFans& fans, const EndPlane& plane,
                                      const std::vector<std::uint32_t>& nodes,
                                      const std::vector<std::uint32_t>& candidates, bool& leaves);

}  // namespace lumen::convert
