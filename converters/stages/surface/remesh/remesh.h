// SPDX-License-Identifier: Apache-2.0
// Near-equilateral triangles, as long as the vessel is wide, on the surface of a case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/remesh/remesh_piece.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

/// Remaining faults after remesh().
struct RemeshReport {
  std::size_t offField = 0;  ///< vertices with no surface of the field near by: they stayed there
  std::size_t sharp = 0;     ///< triangles with an angle under kSharpAngle
};

/// Gives `surface` triangles whose edges follow `edge` (docs/method.md, section 5, Triangles):
/// edges are split, collapsed and flipped, vertices relaxed along the surface and moved onto the
/// field. Topology and groups stay as they are: vertices of a rim stay on it, those of a flat end
/// in its plane. Each vertex keeps a node from which a cursor follows to it. The result is the same
/// on any number of threads. Throws Error(Cancelled).
RemeshReport remesh(CaseSurface& surface, const SeparatedField& field, const EdgeLength& edge,
                    Progress& progress);

/// Remeshes one surface several times, with parts of it kept.
class RepeatedRemesh {
public:
  /// `surface`, `field` and `progress` must stay.
  RepeatedRemesh(const CaseSurface& surface, const SeparatedField& field, const EdgeLength& edge,
                 Progress& progress)
      : m_surface(surface), m_field(field), m_edge(edge), m_progress(progress) {}

  /// Makes `result` the remeshed surface. `isKept`, if it is not empty, marks vertices of the given
  /// surface whose triangles stay as they are; they count as off the field. Pieces far from them
  /// are made once. Throws as remesh().
  RemeshReport run(const std::vector<std::uint8_t>& isKept, CaseSurface& result);

private:
  const CaseSurface& m_surface;
  const SeparatedField& m_field;
  EdgeLength m_edge;
  Progress& m_progress;
  std::vector<std::vector<std::uint32_t>> m_division;  ///< triangles by pieces
  /// The pieces of the run with nothing kept, and the triangles that were cut out as them.
  std::vector<RemeshPiece> m_made;
  std::vector<std::vector<std::uint32_t>> m_cutOut;
};

}  // namespace lumen::convert
