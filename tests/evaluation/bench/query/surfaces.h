// SPDX-License-Identifier: Apache-2.0
// A vessel, and the points of a tool that is pushed through it.
#pragma once

#include <string>
#include <vector>

#include "vessel.h"

namespace lumen::bench {

struct Surface {
  std::size_t toolPoints = 0;
  std::vector<double> points;  ///< x, y, z, mm: frames of toolPoints points, one after another
  [[nodiscard]] std::size_t frames() const { return points.size() / 3 / toolPoints; }
};

/// "capsule" and "spiral" are made here, after Yureidini's thesis, 5.5.2; anything else is the path
/// of a case. The tool lies between axis and wall, or all of it near the wall. Throws
/// std::runtime_error.
struct OwnedSurface {
  OwnedVessel owned;
  Surface surface;
};
OwnedSurface makeSurface(const std::string& what, bool atWall);

}  // namespace lumen::bench
