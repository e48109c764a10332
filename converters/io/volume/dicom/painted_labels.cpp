// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/painted_labels.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "converters/base/text.h"

namespace lumen::convert {

Voxels narrowLabels(std::vector<std::uint16_t> labels) {
  const auto isWide = [](std::uint16_t label) {
    return label > std::numeric_limits<std::uint8_t>::max();
  };
  if (std::any_of(labels.begin(), labels.end(), isWide)) return labels;
  return std::vector<std::uint8_t>(labels.begin(), labels.end());
}

Voxels paintedLabels(std::size_t count, const std::vector<PaintedStructure>& structures,
                     std::vector<std::string>& assumptions) {
  std::vector<std::size_t> sizes(structures.size(), 0), order(structures.size());
  for (std::size_t s = 0; s < structures.size(); ++s)
    structures[s].voxels([&](std::size_t) { ++sizes[s]; });
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(sizes[b], b) < std::pair(sizes[a], a);
  });
  std::vector<std::uint16_t> labels(count, 0);
  std::size_t overlaps = 0;
  for (const std::size_t s : order) {
    const auto own = static_cast<std::uint16_t>(structures[s].label);
    structures[s].voxels([&](std::size_t voxel) {
      overlaps += labels[voxel] != 0 && labels[voxel] != own ? 1 : 0;
      labels[voxel] = own;
    });
  }
  if (overlaps > 0)
    assumptions.push_back("its structures overlap in " + counted(overlaps, "voxel", "voxels") +
                          "; such a voxel is of the smallest of them");
  return narrowLabels(std::move(labels));
}

}  // namespace lumen::convert
