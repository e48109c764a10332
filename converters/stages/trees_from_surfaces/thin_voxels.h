// SPDX-License-Identifier: Apache-2.0
// Voxels of vessels that are drawn one voxel wide.
#pragma once

#include <array>
#include <cstddef>

namespace lumen::convert {

/// The voxels of a block of 2 x 2 x 2 with its lowest corner at (x, y, z), bit by bit, x first.
/// `isIn(x, y, z)`: true for a voxel of the labels.
template <class IsIn>
unsigned gatherBlock(int x, int y, int z, const IsIn& isIn) {
  unsigned bits = 0;
  for (unsigned i = 0; i < 8; ++i)
    if (isIn(x + static_cast<int>(i & 1U), y + static_cast<int>(i >> 1U & 1U),
             z + static_cast<int>(i >> 2U & 1U)))
      bits |= 1U << i;
  return bits;
}

/// Whether the voxels of a block meet at faces, directly or through one another.
constexpr bool isJoinedByFaces(unsigned bits) {
  unsigned reached = bits & (~bits + 1);
  for (int step = 0; step < 8; ++step) {
    const unsigned along = (reached & 0x55U) << 1U | (reached & 0xAAU) >> 1U |
                           (reached & 0x33U) << 2U | (reached & 0xCCU) >> 2U |
                           (reached & 0x0FU) << 4U | (reached & 0xF0U) >> 4U;
    reached |= along & bits;
  }
  return reached == bits;
}

/// Whether a voxel of the labels is in no block of 2 x 2 x 2 of them.
template <class IsIn>
bool isThinVoxel(const std::array<int, 3>& voxel, const IsIn& isIn) {
  for (int corner = 0; corner < 8; ++corner)
    if (gatherBlock(voxel[0] - (corner & 1), voxel[1] - (corner >> 1 & 1), voxel[2] - (corner >> 2),
                    isIn) == 0xFFU)
      return false;
  return true;
}

/// Whether a voxel that is not of the labels lies between thin ones that meet at an edge or a
/// corner alone, as lines do that are drawn one voxel wide.
template <class IsIn>
bool joinsThinVoxels(const std::array<int, 3>& voxel, const IsIn& isIn) {
  for (int corner = 0; corner < 8; ++corner) {
    const int x = voxel[0] - (corner & 1), y = voxel[1] - (corner >> 1 & 1),
              z = voxel[2] - (corner >> 2);
    const unsigned bits = gatherBlock(x, y, z, isIn);
    if (isJoinedByFaces(bits)) continue;
    bool areThin = true;
    for (unsigned i = 0; i < 8 && areThin; ++i)
      if ((bits >> i & 1U) != 0)
        areThin = isThinVoxel({x + static_cast<int>(i & 1U), y + static_cast<int>(i >> 1U & 1U),
                               z + static_cast<int>(i >> 2U)},
                              isIn);
    if (areThin) return true;
  }
  return false;
}

}  // namespace lumen::convert
