// SPDX-License-Identifier: Apache-2.0
#include "formats/case/blobby.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lumen::formats {
namespace {

constexpr double kTolerance = 1e-13;
constexpr int kMaxIterations = 400;

// The zero of a function that grows from below zero at `low` to zero or above at `high`: Newton's
// steps where they stay in the bracket and shrink it, bisection elsewhere. `evaluate` gives value
// and slope.
template <class Function>
double growingRoot(double low, double high, Function evaluate) {
  double x = high, lastWidth = high - low;
  for (int i = 0; i < kMaxIterations; ++i) {
    const auto [value, slope] = evaluate(x);
    if (value == 0.0) return x;
    (value < 0.0 ? low : high) = x;
    double next = x - value / slope;
    const double width = high - low;
    if (!(next > low && next < high) || (i % 3 == 2 && width > 0.5 * lastWidth))
      next = low + 0.5 * width;
    if (i % 3 == 2) lastWidth = width;
    if (std::abs(next - x) <= kTolerance * std::abs(next)) return next;
    x = next;
  }
  return x;
}

}  // namespace

KernelValue evaluateKernel(Kernel kernel, double parameter, double x) {
  const double s = field::chainScale(kernel, parameter);
  return field::withKernel(kernel, [x, s](auto k) { return k.chain(s * x, s); });
}

double isoRadius(Kernel kernel, double parameter, double width, double level) {
  const double q = level / width;
  if (!(q > 0.0 && q < 1.0)) return 0.0;
  return width * std::sqrt(field::inversePhi(kernel, parameter, q));
}

double widthForRadius(Kernel kernel, double parameter, double radius, double level, int count) {
  if (!(radius >= 0.0 && level > 0.0 && count > 0) || !std::isfinite(radius + level))
    return std::numeric_limits<double>::quiet_NaN();
  const auto excess = [&](double w) {
    const double x = (radius / w) * (radius / w);
    const KernelValue k = evaluateKernel(kernel, parameter, x);
    return std::pair(count * w * k.phi - level, count * (k.phi - 2.0 * x * k.d1));
  };
  // phi <= 1 gives a lower bound, and a compact blob must reach as far as the radius
  double low = level / count;
  if (field::isCompact(kernel)) low = std::max(low, radius);
  double high = low;
  while (excess(high).first < 0.0) {
    low = high;
    high *= 2.0;
  }
  return high == low ? high : growingRoot(low, high, excess);
}

FieldValue evaluateField(const BlobbyModels& models, std::uint32_t node, const Vec3d& point) {
  FieldValue sum;
  for (std::uint32_t j = models.offset[node]; j < models.offset[node + 1]; ++j) {
    const double width = models.width[j];
    const Vec3d delta{(point.x - double{models.centre[j].x}) / width,
                      (point.y - double{models.centre[j].y}) / width,
                      (point.z - double{models.centre[j].z}) / width};
    const double x = delta.x * delta.x + delta.y * delta.y + delta.z * delta.z;
    const KernelValue k = evaluateKernel(models.kernel, models.kernelParameter, x);
    sum.f += width * k.phi;
    sum.gradient.x += 2.0 * k.d1 * delta.x;
    sum.gradient.y += 2.0 * k.d1 * delta.y;
    sum.gradient.z += 2.0 * k.d1 * delta.z;
  }
  return sum;
}

}  // namespace lumen::formats
