// SPDX-License-Identifier: Apache-2.0
// Segments against the wall.
#pragma once

#include "model.h"

namespace lumen::blob {

/// blob_segment_hit() with finite ends; `hit` is zero before. `node` has followed `from`.
void findHit(const blob_model& model, std::uint32_t flags, const double* from, const double* to,
             std::uint32_t node, double tolerance, std::uint32_t maxSteps, blob_hit& hit) noexcept;

/// blob_capsule_approach() with finite ends, except for the depth.
void findDeepest(const blob_model& model, std::uint32_t flags, const double* from, const double* to,
                 std::uint32_t node, blob_approach& approach) noexcept;

}  // namespace lumen::blob
