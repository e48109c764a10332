// SPDX-License-Identifier: Apache-2.0
// The target lengths of the edges of a mesh.
#pragma once

#include <limits>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/length.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// The length of edges: a share of the local radius, within bounds.
struct EdgeLength {
  double share = 0.25;  ///< share of the radius
  double minimum = 0;   ///< mm; gives way where fewer than eight edges would go round a vessel
  double maximum = std::numeric_limits<double>::infinity();  ///< mm
  /// Greatest distance of the chord of a circle of the radius from the circle; 0: any distance.
  Length sag{};
};

/// Length by `edge` for a vessel of that radius, mm; at most an eighth of its circumference.
double edgeAt(const EdgeLength& edge, double radius);

/// The radius of the vessel at each vertex, mm: between nodes of a branch it is linear.
std::vector<double> vesselRadii(const CaseSurface& surface, const SheetField& field);

/// Lowers lengths that exceed the one at another vertex by more than a quarter of the distance to
/// it.
void gradeLengths(const TriangleMesh& mesh, std::vector<double>& length);

/// The length of edges at each vertex, mm: that of `edge` for the radius there, at most an eighth
/// of the circumference, and nowhere longer than at another vertex by more than a quarter of the
/// distance to it, so that a thin branch's short edges grow gently into a wide one's.
std::vector<double> targetLengths(const CaseSurface& surface, const SheetField& field,
                                  const EdgeLength& edge);

}  // namespace lumen::convert
