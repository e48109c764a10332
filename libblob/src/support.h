// SPDX-License-Identifier: Apache-2.0
// What all paths share, outside of their hot loops.
#pragma once

#include <cmath>
#include <cstdint>

#include "model.h"

namespace lumen::blob {

inline bool isFinitePoint(const double* p) noexcept {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

inline bool isNear(const NodeRecord& node, const double* p) noexcept {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += std::abs(p[i] - node.centre[i]);
  return sum <= kFar;
}

/// The node of least power, the lowest index among equals. The point is finite.
std::uint32_t locateNode(const blob_model& model, const double* point) noexcept;

/// The same, and BLOB_NOWHERE for other points.
std::uint32_t locateAny(const blob_model& model, const double* point) noexcept;

/// The answer at a point that is not finite, or farther than kFar from its node.
void answerRemote(const blob_model& model, const double* point, std::uint32_t node,
                  blob_sample& sample) noexcept;

/// Replaces distance and normal by those of the nearest point of the wall.
void refineSample(const blob_model& model, std::uint32_t flags, const double* point,
                  blob_sample& sample) noexcept;

/// The node for a query at a finite point: the cursor, or located, and followed unless held.
std::uint32_t nodeFor(const blob_model& model, std::uint32_t flags, const double* point,
                      std::uint32_t cursor) noexcept;

/// blob_query_second() at a finite point within kFar of its node, which is not moved.
void evaluateSecond(const blob_model& model, std::uint32_t flags, const double* point,
                    std::uint32_t node, blob_second& second) noexcept;

}  // namespace lumen::blob
