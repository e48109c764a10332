// SPDX-License-Identifier: Apache-2.0
#include "formats/field/repeatable_math.h"

#include <cmath>
#include <limits>

namespace lumen::field {
double repeatableExp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.79) return std::numeric_limits<double>::infinity();
  if (x < -745.2) return 0.0;
  const double k = std::floor(x * kInverseLn2 + 0.5);
  const double high = x - k * kLn2High;
  const double low = k * kLn2Low;
  const double r = high - low;  // |r| <= ln 2 / 2
  // Taylor: the first term left out is below 5e-18
  double tail = 1.0 / 14.0;
  for (int n = 13; n >= 2; --n) tail = (1.0 + r * tail) / n;
  // exp(r) = 1 + r + r^2 tail, and what rounding took from r is added back
  const double lost = (high - r) - low;
  const double sum = 1.0 + (r + (r * r * tail + lost));
  return std::ldexp(sum, static_cast<int>(k));
}

double repeatableLog(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0x1.6a09e667f3bcdp-1) {  // sqrt(1/2): keeps |m - 1| small on both sides
    m *= 2.0;
    --exponent;
  }
  // ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172; the first term left out is below 1e-19
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double series = 0.0;
  for (int n = 23; n >= 3; n -= 2) series = s2 * (1.0 / n + series);
  const double k = exponent;
  return k * kLn2High + (2.0 * s + (2.0 * s * series + k * kLn2Low));
}

double repeatableSine(double x) {
  // Taylor: the first term left out is below 1e-17 of the sum
  const double x2 = x * x;
  double series = 1.0;
  for (int n = 22; n >= 2; n -= 2) series = 1.0 - x2 / (n * (n + 1)) * series;
  return x * series;
}

double repeatableArctangent(double t) {
  // two halvings of the angle: tan(a / 2) = tan a / (1 + sqrt(1 + tan^2 a)) < 0.2
  for (int i = 0; i < 2; ++i) t = t / (1.0 + std::sqrt(1.0 + t * t));
  const double t2 = t * t;
  double series = 0.0;  // Taylor: the first term left out is below 1e-19
  for (int n = 25; n >= 1; n -= 2) series = 1.0 / n - t2 * series;
  return 4.0 * t * series;
}

}  // namespace lumen::field
