// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_measures.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

double calibreOf(const Section& section) {
  return 2 * std::sqrt(section.area / std::numbers::pi);
}

Measured taperOf(const std::vector<CourseSample>& samples, std::size_t first, std::size_t last) {
  constexpr int kFewestOfTaper = 3;
  int count = 0;
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0, variance = 0, width = 0;
  const double origin = samples.empty() ? 0 : samples[first].along;
  for (std::size_t i = first; i < last; ++i) {
    if (!samples[i].section) continue;
    const double u = samples[i].along - origin, d = calibreOf(*samples[i].section);
    ++count;
    x += u, y += d, xx += u * u, xy += u * d, yy += d * d;
    variance += 4 * samples[i].meanSd * samples[i].meanSd;
    width += samples[i].axis.radius;
  }
  if (count == 0 && first < last) return notDefined(samples[first].absent);
  if (count < kFewestOfTaper) return notDefined("fewer than three cross-sections around it");
  const double n = count, spread = xx - x * x / n;
  if (!(spread > 0)) return notDefined("its cross-sections are at one place");
  const double slope = (xy - x * y / n) / spread;
  const double rest = std::max(0.0, yy - y * y / n - slope * slope * spread) / std::max(1.0, n - 2);
  // sections nearer than a radius share their wall points
  const double step = (samples[last - 1].along - samples[first].along) / std::max(1.0, n - 1);
  const double alike = std::max(1.0, width / n / std::max(step, 1e-9));
  const double own = std::isfinite(variance) ? std::max(rest, variance / n) : rest;
  return measured(-slope, std::sqrt(own * alike / spread));
}

}  // namespace lumen::convert
