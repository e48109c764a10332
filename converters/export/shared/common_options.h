// SPDX-License-Identifier: Apache-2.0
// Options that several targets of `lumen export` take.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/export/shared/frame.h"
#include "converters/stages/surface/closed_surface.h"

namespace lumen::convert {

/// Edges of exported walls, in radii: a simulator asks a wall of triangles many times a step, and
/// its curvature needs edges of half the radius.
inline constexpr double kExportedEdge = 0.5;

inline ClosedSurfaceOptions exportedSurfaceOptions() {
  ClosedSurfaceOptions options;
  options.edge.share = kExportedEdge;
  return options;
}

struct CommonOptions {
  std::optional<LengthUnit> unit;  ///< one of the target's; none: the first of these
  std::optional<Axes> axes;        ///< one of the target's; none: the first of these
  ClosedSurfaceOptions surface = exportedSurfaceOptions();
  double spacing = 0;  ///< mm between samples of grids; 0: by the size of the vessels
  /// Inlets of a flow, as statedInlets() takes them; empty: found by the case.
  std::vector<std::string> inlets;
  /// Greatest number of pieces of a wall that is divided; 0: the target's own.
  std::uint64_t maxPieces = 0;
  std::string insert;  ///< label of the branch where an instrument enters; empty: the root
};

}  // namespace lumen::convert
