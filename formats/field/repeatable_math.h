// SPDX-License-Identifier: Apache-2.0
// Elementary functions of doubles with the same bits on every machine with IEEE 754 arithmetic,
// which the C library does not promise.
#pragma once

#include <bit>
#include <cstdint>

namespace lumen::field {

/// ln 2 in two parts; the high one has 33 bits, so that its product with an exponent is exact
/// (W. Cody and W. Waite, "Software manual for the elementary functions", 1980).
inline constexpr double kLn2High = 0x1.62e42feep-1;
inline constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
inline constexpr double kInverseLn2 = 0x1.71547652b82fep+0;

/// exp(x) for any x, to about one unit in the last place.
double repeatableExp(double x);

/// The natural logarithm of x > 0, to about one unit in the last place.
double repeatableLog(double x);

/// sin(x) for 0 <= x <= pi / 2, to about one unit in the last place.
double repeatableSine(double x);

/// The angle whose tangent is t, for 0 <= t <= 1, to about one unit in the last place.
double repeatableArctangent(double t);

/// exp(-t) for t >= 0 to a relative 1e-15, and exp(-700) beyond t = 700: without branches or calls,
/// so that loops over it vectorise.
[[gnu::always_inline]] inline double expOfMinus(double t) {
  constexpr double kShift = 0x1.8p52;  // leaves the nearest integer in the low bits of the sum
  const double x = -(t < 700.0 ? t : 700.0);
  const double shifted = x * kInverseLn2 + kShift;
  const double n = shifted - kShift;
  const double r = (x - n * kLn2High) - n * kLn2Low;  // |r| <= ln 2 / 2
  // Taylor
  double p = 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  const auto power = (std::bit_cast<std::uint64_t>(shifted) + 1023U) << 52U;  // 2^n
  return p * std::bit_cast<double>(power);
}

}  // namespace lumen::field
