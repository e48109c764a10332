// SPDX-License-Identifier: Apache-2.0
// The nearest point of the wall.
#pragma once

#include "model.h"

namespace lumen::blob {

/// As blob_nearest(), for a finite point within kFar of its node, which is not moved.
void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept;

/// One sample without refinement; the cursor follows.
blob_sample sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
                     std::uint32_t& node) noexcept;

}  // namespace lumen::blob
