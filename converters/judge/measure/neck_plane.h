// SPDX-License-Identifier: Apache-2.0
// The plane that cuts a sac off its vessels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/measure/local_surface.h"

namespace lumen::convert {

/// All points x with normal . x = offset; the sac lies where it is greater.
struct NeckPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;  ///< mm
};

/// The surroundings of a neck.
struct NeckPlace {
  Eigen::Vector3d vessel;             ///< the sac's attachment on the axis of its vessel, mm
  Eigen::Vector3d sac;                ///< a point within the sac, mm
  std::vector<Eigen::Vector3d> axes;  ///< nodes of vessels near by, which are not of the sac
};

/// Cuts a surface by planes. Keeps memory between cuts; serves one thread.
class PlaneCutter {
public:
  /// The surface must stay.
  PlaneCutter(const LocalSurface& surface, const NeckPlace& place);

  struct Cut {
    double area = 0;    ///< mm^2, of the section
    double volume = 0;  ///< mm^3, of the part beyond
  };
  /// The part beyond a plane in which the sac's point lies. Nothing if that part runs out of the
  /// box, or has the axis of a vessel in it.
  std::optional<Cut> cut(const NeckPlane& plane);
  [[nodiscard]] const LocalSurface& surface() const { return m_surface; }
  [[nodiscard]] const NeckPlace& place() const { return m_place; }
  /// The place of the wall behind the sac's point, seen from its vessel, mm.
  [[nodiscard]] const Eigen::Vector3d& farSide() const { return m_surface.mesh.position[m_seed]; }
  /// The vertices of the part that the last cut() found.
  [[nodiscard]] bool isBeyond(std::uint32_t vertex) const { return m_side[vertex] == Side::Beyond; }

private:
  /// Side of a vertex: below the plane, above it, or above it and joined to the sac.
  enum class Side : std::uint8_t { Below, Above, Beyond };

  void listNeighbours();
  bool grow();
  [[nodiscard]] Cut measure(const NeckPlane& plane) const;

  const LocalSurface& m_surface;
  NeckPlace m_place;
  std::uint32_t m_seed;                              // the vertex at the far side
  std::vector<std::uint32_t> m_axisVertex;           // nearest vertex to each node of a vessel
  std::vector<std::uint32_t> m_offset, m_neighbour;  // of each vertex, each once
  std::vector<double> m_height;
  std::vector<Side> m_side;
  std::vector<std::uint32_t> m_open;
};

/// The neck: of all planes that separate the sac from its vessels, below its widest section, that
/// whose section is the smallest for the volume beyond: least area / volume^(2/3). On a neck like an
/// hourglass that is its narrowest place, but for a shift of 1 % of the neck's width; on a neck of
/// even width, its end at the vessel; on a sac that sits on the wall of a vessel, the plane that
/// touches the vessel. Nothing if no plane within 45 degrees of the sac's direction separates it.
std::optional<NeckPlane> findNeck(PlaneCutter& surface, const Progress& progress);

/// The neck on a finer surface, near one that was found on a coarser one.
std::optional<NeckPlane> refineNeck(const NeckPlane& found, PlaneCutter& fine,
                                    const Progress& progress);

}  // namespace lumen::convert
