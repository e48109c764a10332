// SPDX-License-Identifier: Apache-2.0
// Fewer triangles of a surface, for pictures while the scene moves.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::viewer {

/// A run of triangles.
struct TriangleRun {
  std::size_t first = 0, count = 0;
};

/// Triangles between the same vertices, run by run.
struct MovingSurface {
  std::vector<convert::Triangle> triangle;
  std::vector<TriangleRun> run;  ///< one for each run of the surface
};

/// Each run of `triangle` with a share of its triangles, so that all have about `most`, but no wall
/// moved by more than a third of its radius. `radius` is that of each vertex, mm. A run is never
/// empty if it was not.
MovingSurface movingSurface(std::span<const convert::Float3> position,
                            std::span<const float> radius,
                            std::span<const convert::Triangle> triangle,
                            std::span<const TriangleRun> run, std::size_t most);

}  // namespace lumen::viewer
