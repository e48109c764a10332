// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/overlaps.h"

#include <algorithm>
#include <map>
#include <utility>

#include <tbb/parallel_for.h>

namespace lumen::convert {

std::vector<Overlap> findOverlaps(const CaseSurface& surface, const SheetField& field) {
  const std::size_t count = surface.mesh.position.size();
  std::vector<SheetSample> samples(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    if (field.mayTouch(surface.node[v]))
      samples[v] = field.at(surface.mesh.position[v], surface.node[v]);
  });
  const std::vector<std::uint32_t>& branch = field.source().tree.branch;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Overlap> found;
  for (std::size_t v = 0; v < count; ++v) {
    // walls that only come near each other are moved by less than the gap
    const double depth = -samples[v].wall;
    if (!samples[v].isSeparated || depth <= field.options().gap) continue;
    const std::pair<std::uint32_t, std::uint32_t> pair =
        std::minmax(branch[samples[v].node], branch[samples[v].other]);
    Overlap& overlap = found[pair];
    if (depth > overlap.depth) overlap = {pair.first, pair.second, depth, surface.mesh.position[v]};
  }
  std::vector<Overlap> overlaps;
  for (const auto& [pair, overlap] : found) overlaps.push_back(overlap);
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
  return overlaps;
}

}  // namespace lumen::convert
