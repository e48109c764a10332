// SPDX-License-Identifier: Apache-2.0
#include "distance_grid.h"

#include <tbb/parallel_for.h>

namespace lumen::bench {

DistanceGrid::DistanceGrid(const Vessel& vessel) : cell(vessel.gridCell) {
  const blob_model_info info = blob_model_describe(vessel.model);
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = info.low[i] - 1;
    size[i] = static_cast<std::size_t>((info.high[i] - info.low[i] + 2) / cell) + 2;
  }
  value.resize(size[0] * size[1] * size[2]);
  tbb::parallel_for(std::size_t{0}, size[2], [&](std::size_t z) {
    std::size_t at = z * size[0] * size[1];
    for (std::size_t y = 0; y < size[1]; ++y)
      for (std::size_t x = 0; x < size[0]; ++x) {
        const double p[3] = {low[0] + cell * static_cast<double>(x),
                             low[1] + cell * static_cast<double>(y),
                             low[2] + cell * static_cast<double>(z)};
        std::uint32_t cursor = BLOB_NOWHERE;
        blob_sample s;
        blob_query(vessel.model, 0, p, &cursor, &s);
        value[at++] = static_cast<float>(s.distance);
      }
  });
}

}  // namespace lumen::bench
