// SPDX-License-Identifier: Apache-2.0
// Curves that were drawn or computed one by one, as one tree.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

struct CurvePoint {
  Eigen::Vector3d position;
  double radius = 0;  ///< 0: unknown
};

/// In any unit.
struct CenterlineCurve {
  std::string name;
  std::vector<CurvePoint> points;
  std::int32_t parent = -1;       ///< index of the curve that it hangs on, if the file says so
  std::int64_t parentPoint = -1;  ///< and the index of that one's point, which then is the place
};

/// The points and vessels of a file; the rest of it is left for the caller to say. What a curve
/// shares with an earlier one from its first point on, as lines from a root to every tip do, is
/// there once: it is the same as long as it stays within a tenth of that one's radius. A curve hangs
/// on the one in whose lumen it begins, or which its parent is; else on the one in whose lumen it
/// ends, and is turned round; else it is a root. Where a curve that hangs on another one ends in the
/// lumen of a third (or of the same, farther on), a link closes the loop. A curve that has been
/// placed as a whole before is left out. Curves that nothing leads to begin with the widest.
CenterlineFile joinCurves(const std::vector<CenterlineCurve>& curves);

}  // namespace lumen::convert
