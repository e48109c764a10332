// SPDX-License-Identifier: Apache-2.0
// Loss of calibre along a vessel (docs/measures.md, section 3).
#pragma once

#include <cstddef>
#include <vector>

#include "converters/judge/measure/measured.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

/// Loss of diameter for each mm of the samples [first, last), by a line of least squares through the
/// diameters of the circles of their sections' area.
Measured taperOf(const std::vector<CourseSample>& samples, std::size_t first, std::size_t last);

/// Diameter of the circle of a section's area, mm.
double calibreOf(const Section& section);

}  // namespace lumen::convert
