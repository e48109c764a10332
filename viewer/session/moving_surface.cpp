// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/moving_surface.h"

#include <algorithm>
#include <cstdint>

#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

namespace lumen::viewer {

namespace {

using convert::Triangle;

constexpr double kMostError = 1.0 / 3;  // share of the mean radius by which a wall may move
constexpr std::size_t kLeast = 16;      // triangles of a run, where it has as many

/// The triangles of one run, between vertices that are numbered as they come.
struct RunMesh {
  std::vector<std::uint32_t> index, vertex;  ///< `vertex`: the number in the surface of each
  std::vector<convert::Float3> position;
  double meanRadius = 0;
};

RunMesh runMesh(std::span<const convert::Float3> position, std::span<const float> radius,
                std::span<const Triangle> triangle) {
  RunMesh mesh;
  for (const Triangle& t : triangle) mesh.vertex.insert(mesh.vertex.end(), t.begin(), t.end());
  std::sort(mesh.vertex.begin(), mesh.vertex.end());
  mesh.vertex.erase(std::unique(mesh.vertex.begin(), mesh.vertex.end()), mesh.vertex.end());
  mesh.index.reserve(3 * triangle.size());
  for (const Triangle& t : triangle)
    for (const std::uint32_t v : t)
      mesh.index.push_back(static_cast<std::uint32_t>(
          std::lower_bound(mesh.vertex.begin(), mesh.vertex.end(), v) - mesh.vertex.begin()));
  for (const std::uint32_t v : mesh.vertex) {
    mesh.position.push_back(position[v]);
    mesh.meanRadius += double{radius[v]} / static_cast<double>(mesh.vertex.size());
  }
  return mesh;
}

std::vector<Triangle> simplified(const RunMesh& mesh, double share) {
  const std::size_t count = mesh.index.size() / 3,
                    wanted = std::max(static_cast<std::size_t>(share * static_cast<double>(count)),
                                      std::min(count, kLeast));
  const float* const place = mesh.position.empty() ? nullptr : mesh.position[0].data();
  constexpr std::size_t kStride = sizeof(convert::Float3);
  const double extent{meshopt_simplifyScale(place, mesh.position.size(), kStride)};
  const auto error =
      static_cast<float>(extent > 0 ? std::min(1.0, kMostError * mesh.meanRadius / extent) : 0.0);
  std::vector<std::uint32_t> kept(mesh.index.size());
  kept.resize(meshopt_simplify(kept.data(), mesh.index.data(), mesh.index.size(), place,
                               mesh.position.size(), kStride, 3 * wanted, error));
  if (kept.empty()) kept = mesh.index;
  // neighbours follow one another: a vertex is then transformed once instead of up to six times
  meshopt_optimizeVertexCache(kept.data(), kept.data(), kept.size(), mesh.position.size());
  std::vector<Triangle> triangles(kept.size() / 3);
  for (std::size_t i = 0; i < kept.size(); ++i) triangles[i / 3][i % 3] = mesh.vertex[kept[i]];
  return triangles;
}

}  // namespace

MovingSurface movingSurface(std::span<const convert::Float3> position,
                            std::span<const float> radius, std::span<const Triangle> triangle,
                            std::span<const TriangleRun> run, std::size_t most) {
  const double share =
      std::min(1.0, static_cast<double>(most) /
                        static_cast<double>(std::max<std::size_t>(triangle.size(), 1)));
  std::vector<std::vector<Triangle>> parts(run.size());
  tbb::parallel_for(std::size_t{0}, run.size(), [&](std::size_t i) {
    const auto [first, count] = run[i];
    parts[i] = simplified(runMesh(position, radius, triangle.subspan(first, count)), share);
  });
  MovingSurface moving;
  for (const std::vector<Triangle>& part : parts) {
    moving.run.push_back({moving.triangle.size(), part.size()});
    moving.triangle.insert(moving.triangle.end(), part.begin(), part.end());
  }
  return moving;
}

}  // namespace lumen::viewer
