// SPDX-License-Identifier: Apache-2.0
#include "formats/field/pose.h"

#include <algorithm>
#include <cmath>

#include "formats/field/repeatable_math.h"

namespace lumen::field {
namespace {

// Half the angle of the rotation from one unit quaternion to another that is not opposite, along
// the shorter arc; W. Kahan, "How futile are mindless assessments of roundoff in floating-point
// computation?", 2006, section 12: exact for small angles and for large ones.
double halfAngle(const Quaternion& a, const Quaternion& b) {
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    difference += (b[i] - a[i]) * (b[i] - a[i]);
    sum += (b[i] + a[i]) * (b[i] + a[i]);
  }
  return 2.0 * repeatableArctangent(std::sqrt(difference) / std::sqrt(sum));
}

double product(const Quaternion& a, const Quaternion& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

Quaternion opposite(const Quaternion& q) {
  return {-q[0], -q[1], -q[2], -q[3]};
}

}  // namespace

Quaternion unit(Quaternion q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& x : q) x /= length;
  return q;
}

Quaternion slerp(const Quaternion& a, Quaternion b, double u) {
  if (product(a, b) < 0) b = opposite(b);
  const double angle = halfAngle(a, b);
  const double sine = repeatableSine(angle);
  if (!(sine > 0) || u <= 0) return u < 0.5 ? a : b;
  if (u >= 1) return b;
  const double from = repeatableSine((1.0 - u) * angle) / sine;
  const double to = repeatableSine(u * angle) / sine;
  Quaternion q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = from * a[i] + to * b[i];
  return unit(q);
}

double angleBetween(const Quaternion& a, const Quaternion& b) {
  return 2.0 * halfAngle(a, product(a, b) < 0 ? opposite(b) : b);
}

Instant instantAt(std::span<const double> times, double period, double time) {
  const std::size_t last = times.size() - 1;
  if (period > 0) {
    const double passed = time - times.front();
    const double within = passed - period * std::floor(passed / period);
    time = times.front() + (within < period ? std::max(within, 0.0) : 0.0);
    if (time >= times.back()) {
      const double rest = times.front() + period - times.back();
      return {last, 0, std::min((time - times.back()) / rest, 1.0)};
    }
  }
  if (!(time > times.front())) return {0, 0, 0};
  if (time >= times.back()) return {last, last, 0};
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto to = static_cast<std::size_t>(after - times.begin());
  return {to - 1, to, (time - times[to - 1]) / (times[to] - times[to - 1])};
}

}  // namespace lumen::field
