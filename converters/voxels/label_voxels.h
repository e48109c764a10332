// SPDX-License-Identifier: Apache-2.0
// Voxels that are labels, and not the grey values of an image.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// True if neighbours that are not 0 differ as the grey values of an image do; labels have equal
/// neighbours but at their borders.
template <class T>
bool isGrey(const std::vector<T>& voxels) {
  // share of neighbours that differ, beyond which voxels are no labels
  constexpr double kGreyShare = 1.0 / 3;
  std::size_t pairs = 0, different = 0;
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    if (voxels[i] == T{} || voxels[i - 1] == T{}) continue;
    ++pairs;
    different += voxels[i] != voxels[i - 1];
  }
  return static_cast<double>(different) > kGreyShare * static_cast<double>(pairs);
}

/// True for whole numbers whose voxels are equal to their neighbours, but at borders, as labels are:
/// a mask or a label map. One value alone is none.
bool holdsLabels(const Voxels& voxels);
inline bool holdsLabels(const Volume& volume) {
  return holdsLabels(volume.voxels);
}

}  // namespace lumen::convert
