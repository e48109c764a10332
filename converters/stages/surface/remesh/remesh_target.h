// SPDX-License-Identifier: Apache-2.0
// The target lengths of the edges of a mesh.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_options.h"
#include "formats/case/case.h"

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
std::vector<double> vesselRadii(const CaseSurface& surface, const SeparatedField& field);

/// Lowers lengths that exceed the one at another vertex by more than a quarter of the distance to
/// it.
void gradeLengths(const TriangleMesh& mesh, std::vector<double>& length);

/// The length of edges at each vertex, mm: that of `edge` for the radius there, at most an eighth
/// of the circumference, and nowhere longer than at another vertex by more than a quarter of the
/// distance to it, so that a thin branch's short edges grow gently into a wide one's.
std::vector<double> targetLengths(const CaseSurface& surface, const SeparatedField& field,
                                  const EdgeLength& edge);

// Estimates of the size of the surface of a case.

/// Triangles that a surface may have, and the memory that one takes while it is made.
constexpr double kMaxSurfaceTriangles = 1 << 24, kBytesPerTriangle = 400;

/// The approximate number of triangles of the surface of a tree, with an outer surface if there is
/// a wall of that thickness. O(nodes).
double expectedTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness);

/// Throws Error(InvalidInput) if more than kMaxSurfaceTriangles are to be expected; the sentence
/// states the numbers, and an edge or a thickness that is enough.
void requireFewTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness);

}  // namespace lumen::convert
