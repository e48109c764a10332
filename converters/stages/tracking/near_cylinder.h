// SPDX-License-Identifier: Apache-2.0
// A cylinder through wall candidates next to an expected one, without random numbers
// (docs/method.md, section 1.13).
#pragma once

#include "converters/stages/tracking/cylinder.h"

namespace lumen::convert {

/// The best cylinder through `points` that holds their origin, of those to which robust least
/// squares lead from the expected axis and a few radii around the expected one, or the first whose
/// rate is accepted: candidates count the less the farther they are off, in a band that narrows to
/// that of the inliers. Scores are those of estimateCylinder(), and the radius is 0.5 to 1.8 times
/// the expected one; the rate is 0, without a radius, if none is valid.
Cylinder nearCylinder(const CylinderSearch& search, const Candidates& points,
                      const ExpectedCylinder& expected, CylinderWorkspace& workspace);

}  // namespace lumen::convert
