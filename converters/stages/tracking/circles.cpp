// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/circles.h"

#include <cmath>

#include "converters/base/simd.h"

namespace lumen::convert {
namespace {

/// mm^2: twice the parallelogram of three points, below which they lie on a line within single
/// precision.
constexpr float kOnALine = 1e-12F;

}  // namespace

void drawTriples(const std::vector<float>& u, const std::vector<float>& v, Random& random,
                 CircleBlock& block) {
  const std::uint64_t count = u.size();
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    // one number gives three indices of 21 bits each
    const std::uint64_t bits = random.next();
    const std::size_t i = ((bits & 0x1fffff) * count) >> 21;
    const std::size_t j = (((bits >> 21) & 0x1fffff) * count) >> 21;
    const std::size_t k = (((bits >> 42) & 0x1fffff) * count) >> 21;
    block.u[t] = u[i];
    block.v[t] = v[i];
    block.au[t] = u[j] - u[i];
    block.av[t] = v[j] - v[i];
    block.bu[t] = u[k] - u[i];
    block.bv[t] = v[k] - v[i];
  }
}

LUMEN_SIMD_CLONES void circlesThrough(CircleBlock& block, float low, float high) {
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    const float au = block.au[t], av = block.av[t], bu = block.bu[t], bv = block.bv[t];
    const float det = 2.0F * (au * bv - av * bu);
    const float a2 = au * au + av * av, b2 = bu * bu + bv * bv;
    const float cu = (bv * a2 - av * b2) / det, cv = (au * b2 - bu * a2) / det;
    const float r2 = cu * cu + cv * cv;
    const float u = block.u[t] + cu, v = block.v[t] + cv;
    // the rays start in the lumen, so a circle that does not hold their origin is another vessel's
    const bool valid = (std::abs(det) >= kOnALine) & (r2 >= low * low) & (r2 <= high * high) &
                       (u * u + v * v <= r2);
    block.u[t] = u;
    block.v[t] = v;
    block.squaredRadius[t] = valid ? r2 : 0.0F;  // a root would keep the loop scalar, for errno
  }
}

LUMEN_SIMD_CLONES int countInBand(const float* u, const float* v, std::size_t count, float centreU,
                                  float centreV, float low2, float high2) {
  int inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float du = u[i] - centreU, dv = v[i] - centreV;
    const float d2 = du * du + dv * dv;
    inside += static_cast<int>(d2 >= low2) & static_cast<int>(d2 <= high2);
  }
  return inside;
}

int countInBandReference(const float* u, const float* v, std::size_t count, float centreU,
                         float centreV, float low2, float high2) {
  int inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float du = u[i] - centreU, dv = v[i] - centreV;
    const float d2 = du * du + dv * dv;
    if (d2 >= low2 && d2 <= high2) ++inside;
  }
  return inside;
}

}  // namespace lumen::convert
