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

KernelValue cauchy(double s2, double x) {
  const double q = 1.0 / (1.0 + s2 * x);
  const double phi = q * q;
  const double d1 = -2.0 * s2 * q * phi;
  const double d2 = -3.0 * s2 * q * d1;
  return {phi, d1, d2, -4.0 * s2 * q * d2};
}

KernelValue gaussian(double a2, double x) {
  const double phi = repeatableExp(-a2 * x);
  return {phi, -a2 * phi, a2 * a2 * phi, -a2 * a2 * a2 * phi};
}

KernelValue quartic(double x) {
  if (x >= 1.0) return {0, 0, 0, 0};
  return {(1.0 - x) * (1.0 - x), -2.0 * (1.0 - x), 2.0, 0.0};
}

// 1 - (4/9) x^3 + (17/9) x^2 - (22/9) x, factored so that it loses no digits at the edge.
KernelValue softObject(double x) {
  if (x >= 1.0) return {0, 0, 0, 0};
  const double u = 1.0 - x;
  return {u * u * (9.0 - 4.0 * x) / 9.0, -u * (22.0 - 12.0 * x) / 9.0, (34.0 - 24.0 * x) / 9.0,
          -24.0 / 9.0};
}

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

// x where the soft object's phi falls to q, 0 < q < 1; sought as u = 1 - x, where phi = u^2 (5 + 4
// u) / 9.
double softObjectInverse(double q) {
  const double u = growingRoot(0.0, 1.0, [q](double v) {
    return std::pair(v * v * (5.0 + 4.0 * v) / 9.0 - q, v * (10.0 + 12.0 * v) / 9.0);
  });
  return 1.0 - u;
}

double inverseKernel(Kernel kernel, double parameter, double q) {
  switch (kernel) {
    case Kernel::Cauchy: {
      const double root = std::sqrt(q);
      return (1.0 - q) / (root * (1.0 + root) * parameter);  // (1 / sqrt(q) - 1) / s^2
    }
    case Kernel::Gaussian:
      return -repeatableLog(q) / parameter;
    case Kernel::Quartic:
      return (1.0 - q) / (1.0 + std::sqrt(q));  // 1 - sqrt(q)
    case Kernel::SoftObject:
      return softObjectInverse(q);
  }
  return 0.0;
}

bool isCompact(Kernel kernel) {
  return kernel == Kernel::Quartic || kernel == Kernel::SoftObject;
}

}  // namespace

KernelValue evaluateKernel(Kernel kernel, double parameter, double x) {
  switch (kernel) {
    case Kernel::Cauchy:
      return cauchy(parameter, x);
    case Kernel::Gaussian:
      return gaussian(parameter, x);
    case Kernel::Quartic:
      return quartic(x);
    case Kernel::SoftObject:
      return softObject(x);
  }
  return {0, 0, 0, 0};
}

double defaultKernelParameter(Kernel kernel) {
  if (kernel == Kernel::Cauchy) return 0.2;
  return kernel == Kernel::Gaussian ? 0.5 : 0.0;
}

double isoRadius(Kernel kernel, double parameter, double width, double level) {
  const double q = level / width;
  if (!(q > 0.0 && q < 1.0)) return 0.0;
  return width * std::sqrt(inverseKernel(kernel, parameter, q));
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
  if (isCompact(kernel)) low = std::max(low, radius);
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
