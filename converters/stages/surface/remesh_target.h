// SPDX-License-Identifier: Apache-2.0
// How long the edges of a mesh should be.
#pragma once

#include <limits>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/length.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// The length of edges: a share of the local radius, within bounds.
struct EdgeLength {
  double share = 0.25;  ///< of the radius
  double minimum = 0;   ///< mm; gives way where fewer than eight edges would go round a vessel
  double maximum = std::numeric_limits<double>::infinity();  ///< mm
  /// How far the chord of a circle of the radius may be from it; 0: any distance.
  Length sag{};
};

/// Length that `edge` asks for at a vessel of that radius, mm; at most an eighth of its circumference.
double edgeAt(const EdgeLength& edge, double radius);

/// The radius of the vessel at each vertex, mm: between nodes of a branch it is linear.
std::vector<double> vesselRadii(const CaseSurface& surface, const SheetField& field);

/// Lowers what is longer than at another vertex by more than a quarter of the way to it.
void gradeLengths(const TriangleMesh& mesh, std::vector<double>& length);

/// The length that edges at each vertex should have, mm: as `edge` says for the radius there, at
/// most an eighth of the circumference, and nowhere longer than at another vertex by more than a
/// quarter of the way to it, so that a thin branch's short edges grow gently into a wide one's.
std::vector<double> targetLengths(const CaseSurface& surface, const SheetField& field,
                                  const EdgeLength& edge);

}  // namespace lumen::convert
