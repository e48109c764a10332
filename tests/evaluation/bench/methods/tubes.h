// SPDX-License-Identifier: Apache-2.0
// Tubes as cases.
#pragma once

#include <vector>

#include "formats/case/case.h"

namespace lumen::bench {

/// A tube around a line of nodes, one the parent of the next: each has a model of seven equal blobs on the
/// line, as wide as puts the wall of the straight tube at `radius`, mm. Lines lie in planes of equal z.
formats::Case tubeAlong(const std::vector<formats::Vec3f>& line, double spacing, double radius);

}  // namespace lumen::bench
