// SPDX-License-Identifier: Apache-2.0
// Uncertainty of the wall: spread of wall points around the surface, and the voxel size
// (docs/measures.md, section 7).
#pragma once

#include <cstdint>
#include <vector>

#include "converters/judge/measure/wall.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Standard deviations that make half of a 95 % interval.
inline constexpr double kHalfInterval = 1.96;

/// Uncertainty of the wall along the vessels of a case.
class WallNoise {
public:
  /// Unknown everywhere for a case without wall points.
  WallNoise(const formats::Case& source, const Wall& wall);

  /// Standard deviation of the radius of a section at a node, mm: that of its mean, and of one place
  /// on its wall. NaN where it is unknown.
  [[nodiscard]] double ofMean(std::uint32_t node) const;
  [[nodiscard]] double ofPlace(std::uint32_t node) const;
  /// The part that all sections share, mm.
  [[nodiscard]] double shared() const { return m_shared; }
  [[nodiscard]] bool isKnown() const { return !m_variance.empty(); }

private:
  std::vector<double> m_variance;  // of wall points around the surface, mm^2
  std::vector<double> m_count;     // independent wall points that a section rests on
  double m_shared = 0;
};

}  // namespace lumen::convert
