// SPDX-License-Identifier: Apache-2.0
// Joins curves that were drawn or computed one by one into one tree.
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

/// A curve, in any unit.
struct CenterlineCurve {
  std::string name;
  std::vector<CurvePoint> points;
  std::int32_t parent = -1;  ///< index of the curve to which it is attached, if the file states one
  std::int64_t parentPoint = -1;  ///< index of the parent's point of attachment
};

/// The points and vessels of a file; the caller fills in the rest of it. The beginning that a curve
/// shares with an earlier one from its first point on, as lines from a root to every tip do, is
/// stored once: points are shared while they stay within a tenth of the earlier curve's radius. A
/// curve is attached to its stated parent, or to the curve in whose lumen it begins; else to the
/// curve in whose lumen it ends, and is reversed; else it is a root. A link closes the loop where
/// an attached curve ends in the lumen of a third (or of its parent, farther on). A curve that
/// already lies wholly on placed ones is left out. Curves without a predecessor begin with the
/// widest.
CenterlineFile joinCurves(const std::vector<CenterlineCurve>& curves);

// Interpolation of missing radii in files. Private to the sources of centerline.

/// Points without a radius get one interpolated between the nearest points with radius towards the
/// root and away from it, or a copy if only one of these exists; a remark reports their number.
/// Throws Error(InvalidInput) with `name` if no point of some tree has a radius; `expected` states
/// where a file holds radii.
void fillRadii(CenterlineFile& file, const std::string& name, const char* expected);

}  // namespace lumen::convert
