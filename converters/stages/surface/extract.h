// SPDX-License-Identifier: Apache-2.0
// The closed surface of a case, topologically right and roughly in place.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/adaptive_lattice.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

// Hollows within a solid.

/// Drops the connected parts of a closed surface that look inwards: hollows within others. Returns
/// their number. O(v + t).
std::size_t dropHollows(CaseSurface& surface);

/// Results of extraction besides the surface.
struct ExtractionReport {
  std::size_t trees = 0;  ///< connected trees of the case: closed surfaces
  std::size_t openedEdges =
      0;  ///< tree edges that were opened since the field leaves no lumen there
  /// Places, mm, where a lumen was cut that runs into itself without a link there.
  std::vector<Eigen::Vector3d> cuts;
};

/// A closed, oriented 2-manifold around each connected tree of a case that has models
/// (docs/method.md, section 5): marching tetrahedra on a lattice of cubes whose edges are `edge`. Two sheets that are inside at the ends of one edge and not joined along it both
/// have their walls on it, so vessels that touch share no vertex. The genus of each surface is the
/// number of loops that links close. A union (SeparationOptions::isUnion) has one surface around all
/// vessels that are joined, of any genus, and none around hollows between them. Vertices are within a
/// few per cent of a radius of the field's surface; ends bulge as the field does. All triangles are
/// in group 0.
CaseSurface extractSurface(const SeparatedField& field, const LatticeEdge& edge,
                           ExtractionReport& report, Progress& progress);

}  // namespace lumen::convert
