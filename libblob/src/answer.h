// SPDX-License-Identifier: Apache-2.0
// The test whether a point can be evaluated, and the answer where it cannot.
#pragma once

#include <cmath>
#include <cstdint>

#include "model.h"

namespace lumen::blob {

inline bool isFinitePoint(const double* p) noexcept {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Whether a point is within kFarthestMm of a node, so that no float overflows in the computation
/// of f.
inline bool isInRange(const NodeRecord& node, const double* p) noexcept {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += std::abs(p[i] - node.centre[i]);
  return sum <= kFarthestMm;
}

/// The answer at a point that is not finite, or out of range of its node.
void answerOutOfRange(const blob_model& model, const double* point, std::uint32_t node,
                      blob_sample& sample) noexcept;

}  // namespace lumen::blob
