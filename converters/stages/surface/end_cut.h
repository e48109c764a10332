// SPDX-License-Identifier: Apache-2.0
// What one plane cuts off one end of a surface, before it is done.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/surface/end_planes.h"
#include "converters/stages/surface/flat_region.h"
#include "converters/stages/surface/sheet_field.h"
#include "converters/stages/surface/surface_fans.h"

namespace lumen::convert {

/// A cut that is possible. Numbers of vertices from that of the surface's on are those of `fresh`.
struct EndCut {
  struct Vertex {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::uint32_t node = 0;
  };
  std::vector<std::uint32_t> removed;  ///< triangles
  std::vector<Triangle> kept;          ///< what is left of those that the plane cuts
  std::vector<Vertex> fresh;
  std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> moved;  ///< vertices onto the plane
  std::vector<std::uint32_t> rim;  ///< vertices around the opening, counter-clockwise from outside
  Loop2 loop;                      ///< the same in the coordinates of planeBasis(normal)
  FlatMesh cap;                    ///< its points are the rim's, then new ones
};

/// Why a plane cannot cut an end.
enum class NoCut : std::uint8_t {
  Before,  ///< the surface closes before the plane
  Other,   ///< another vessel, or another part of this one, begins behind the plane
  Handle,  ///< what lies behind the plane is no disc
  Crooked  ///< the rim would cross itself
};

/// The cut of the end of `plane`'s branch: of the connected part beyond the plane at whose vertices
/// cursors are at `nodes` of the end, the one nearest to the axis. Vertices within a quarter of an
/// edge of the plane are moved into it, edges that cross it are split there, and both lie on the
/// field's surface where that is near. The surface stays a manifold of the same genus.
std::variant<EndCut, NoCut> planCut(const SurfaceFans& fans, const SheetField& field,
                                    const EndPlane& plane, const std::vector<std::uint32_t>& nodes,
                                    const std::vector<std::uint32_t>& candidates);

/// Does it; the cap's triangles get `group`. The cut must be of the surface as it is.
void applyCut(SurfaceFans& fans, const EndPlane& plane, const EndCut& cut, std::uint32_t group);

/// The vertices of one connected part of the surface beyond the plane, ascending, found from the one
/// of `candidates` that is beyond it and nearest to the axis; without those at other nodes than
/// `nodes` (ascending), of which `leaves` says whether there are any.
std::vector<std::uint32_t> partBeyond(const SurfaceFans& fans, const EndPlane& plane,
                                      const std::vector<std::uint32_t>& nodes,
                                      const std::vector<std::uint32_t>& candidates, bool& leaves);

}  // namespace lumen::convert
