// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/refine.h"

#include <cstdint>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/stages/surface/box_set.h"
#include "converters/stages/surface/mend_crossings.h"
#include "converters/stages/surface/remesh.h"

namespace lumen::convert {
namespace {

constexpr int kMostRepeats = 4;
constexpr double kFirstReach = 1;  // radii around a crossing

void addPlaces(const CaseSurface& surface, const SheetField& field, const SelfIntersections& found,
               double radii, std::vector<Box3d>& places) {
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair)
      for (const std::uint32_t v : surface.mesh.triangle[t])
        places.emplace_back().add(surface.mesh.position[v], radii * field.radius(surface.node[v]));
}

std::vector<std::uint8_t> verticesIn(const CaseSurface& surface, const std::vector<Box3d>& places) {
  if (places.empty()) return {};
  const BoxSet set(places);
  std::vector<std::uint8_t> isIn(surface.mesh.position.size());
  tbb::parallel_for(std::size_t{0}, isIn.size(), [&](std::size_t v) {
    Box3d point;
    point.add(surface.mesh.position[v]);
    isIn[v] = set.meets(point) ? 1 : 0;
  });
  return isIn;
}

}  // namespace

RefineReport refine(CaseSurface& surface, const SheetField& field, const EdgeLength& edge,
                    Progress& progress) {
  const CaseSurface given = surface;
  RepeatedRemesh remeshing(given, field, edge, progress);
  CrossingSearch search;
  std::vector<Box3d> places;
  double reach = kFirstReach;
  for (int repeats = 0;; ++repeats) {
    const RemeshReport made = remeshing.run(verticesIn(given, places), surface);
    SelfIntersections left = mendCrossings(surface, field, search, progress);
    if (left.pairs.empty()) return {made.offField, made.sharp, 0};
    if (repeats == kMostRepeats) {
      const std::size_t moved = smoothCrossings(surface, left, progress);
      return {made.offField + moved, made.sharp, left.pairs.size()};
    }
    addPlaces(surface, field, left, reach, places);
    reach *= 2;
  }
}

}  // namespace lumen::convert
