// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/mend_crossings.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/stages/surface/box_set.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kMostPairs = 1'000'000;
constexpr int kMostRounds = 8;

std::vector<bool> isOnEnd(const CaseSurface& surface) {
  std::vector<bool> result(surface.mesh.position.size(), false);
  for (std::size_t t = 0; t < surface.mesh.triangle.size(); ++t)
    if (surface.groups[surface.group[t]].kind != FaceKind::Wall)
      for (const std::uint32_t v : surface.mesh.triangle[t]) result[v] = true;
  return result;
}

// The vertices of crossing triangles that may move, ascending.
std::vector<std::uint32_t> crossingVertices(const TriangleMesh& mesh,
                                            const SelfIntersections& found,
                                            const std::vector<bool>& isFixed) {
  std::vector<std::uint32_t> vertices;
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair)
      for (const std::uint32_t v : mesh.triangle[t])
        if (!isFixed[v]) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// The boxes of the triangles that were in `before`, or have a vertex that was moved since.
std::vector<Box3d> changedBoxes(const TriangleMesh& mesh, const SelfIntersections& before,
                                const std::vector<std::uint32_t>& moved) {
  std::vector<std::uint8_t> isMoved(mesh.position.size(), 0), isChanged(mesh.triangle.size(), 0);
  for (const std::uint32_t v : moved) isMoved[v] = 1;
  for (const auto& pair : before.pairs)
    for (const std::uint32_t t : pair) isChanged[t] = 1;
  std::vector<Box3d> boxes;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Triangle& corner = mesh.triangle[t];
    if (isChanged[t] != 0 || isMoved[corner[0]] != 0 || isMoved[corner[1]] != 0 ||
        isMoved[corner[2]] != 0)
      boxes.push_back(boxOf(mesh, corner));
  }
  return boxes;
}

// The crossings after vertices were moved. Two triangles that cross now, and did not before, are
// both near one that changed.
SelfIntersections searchAgain(const TriangleMesh& mesh, const SelfIntersections& before,
                              const std::vector<std::uint32_t>& moved, const Progress& progress) {
  if (!before.isComplete) return selfIntersections(mesh, kMostPairs, &progress);
  const BoxSet changed(changedBoxes(mesh, before, moved));
  std::vector<std::uint8_t> isNear(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, isNear.size(), [&](std::size_t t) {
    isNear[t] = changed.meets(boxOf(mesh, mesh.triangle[t])) ? 1 : 0;
  });
  TriangleMesh part{mesh.position, {}};
  std::vector<std::uint32_t> number;
  for (std::uint32_t t = 0; t < isNear.size(); ++t) {
    if (isNear[t] == 0) continue;
    part.triangle.push_back(mesh.triangle[t]);
    number.push_back(t);
  }
  SelfIntersections found = selfIntersections(part, kMostPairs, &progress);
  for (auto& pair : found.pairs) pair = {number[pair[0]], number[pair[1]]};
  return found;
}

}  // namespace

SelfIntersections mendCrossings(CaseSurface& surface, const SheetField& field, Progress& progress) {
  progress.begin("crossings", 0);
  SelfIntersections found = selfIntersections(surface.mesh, kMostPairs, &progress);
  const std::vector<bool> isFixed = found.pairs.empty() ? std::vector<bool>() : isOnEnd(surface);
  for (int round = 0; !found.pairs.empty() && round < kMostRounds; ++round) {
    const auto moved = crossingVertices(surface.mesh, found, isFixed);
    tbb::parallel_for(std::size_t{0}, moved.size(), [&](std::size_t i) {
      const std::uint32_t v = moved[i];
      Eigen::Vector3d& position = surface.mesh.position[v];
      const SheetSample sample = field.at(position, surface.node[v]);
      const double step = std::max(0.25 * field.options().gap, 0.02 * field.radius(sample.node));
      position -= step * sample.gradient;
    });
    found = searchAgain(surface.mesh, found, moved, progress);
  }
  progress.end();
  return found;
}

}  // namespace lumen::convert
