// SPDX-License-Identifier: Apache-2.0
// The point of a triangle that is nearest to a point; C. Ericson, Real-Time Collision Detection,
// 2005, section 5.1.5.
#pragma once

#include <cstdint>

namespace lumen::bench {

/// Part of a triangle that a point lies on: a corner, the edge that starts there, or the inside.
enum class Feature : std::uint8_t { A, B, C, AB, BC, CA, Face };

inline float dot3(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline float squareOf(const float* a, const float* b) {
  const float d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot3(d, d);
}

inline Feature closestOnTriangle(const float* p, const float* a, const float* b, const float* c,
                                 float* q) {
  float ab[3], ac[3], ap[3], bp[3], cp[3];
  for (int i = 0; i < 3; ++i) {
    ab[i] = b[i] - a[i];
    ac[i] = c[i] - a[i];
    ap[i] = p[i] - a[i];
    bp[i] = p[i] - b[i];
    cp[i] = p[i] - c[i];
  }
  const auto put = [&](float v, float w, Feature feature) {
    for (int i = 0; i < 3; ++i) q[i] = a[i] + v * ab[i] + w * ac[i];
    return feature;
  };
  const float d1 = dot3(ab, ap), d2 = dot3(ac, ap), d3 = dot3(ab, bp), d4 = dot3(ac, bp),
              d5 = dot3(ab, cp), d6 = dot3(ac, cp);
  if (d1 <= 0 && d2 <= 0) return put(0, 0, Feature::A);
  if (d3 >= 0 && d4 <= d3) return put(1, 0, Feature::B);
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return put(d1 / (d1 - d3), 0, Feature::AB);
  if (d6 >= 0 && d5 <= d6) return put(0, 1, Feature::C);
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return put(0, d2 / (d2 - d6), Feature::CA);
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return put(1 - w, w, Feature::BC);
  }
  const float denominator = 1 / (va + vb + vc);
  return put(vb * denominator, vc * denominator, Feature::Face);
}

}  // namespace lumen::bench
