// SPDX-License-Identifier: Apache-2.0
// The least radius that the volume of a case shows (docs/measures.md, section 3).
#pragma once

#include <optional>
#include <string>

#include "converters/judge/measure/measures.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Standard deviation of the blur that tracking recorded, mm; 0 if it recorded none.
double recordedBlur(const formats::Metadata& metadata);

/// Radius of the half level of a line without a width in the volume that the case was made from, mm:
/// a fitted radius below it says no more than that the vessel is at most as wide. Half of a voxel's
/// greatest edge where no blur is recorded; none without a volume.
std::optional<double> leastShownRadius(const formats::Metadata& metadata);

/// "0.512", or "<= 0.433" if the radius is below the least one that is shown.
std::string shownRadius(double radius, std::optional<double> least, int digits);

/// States for all radii and diameters below the least radius that is shown what they are at most.
void boundRadii(std::optional<double> least, CaseMeasures& measures);

}  // namespace lumen::convert
