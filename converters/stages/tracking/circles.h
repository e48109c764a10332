// SPDX-License-Identifier: Apache-2.0
// Circles through three points, many at a time: the hot loops of the search for a cylinder.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "converters/base/random.h"

namespace lumen::convert {

constexpr std::size_t kCircleBlock = 32;

/// Circles as a structure of arrays. All in mm, in a plane whose origin is that of the rays.
struct CircleBlock {
  using Lanes = std::array<float, kCircleBlock>;
  alignas(64) Lanes u, v;            ///< first point of the triple, then the centre
  alignas(64) Lanes au, av, bu, bv;  ///< second and third point, relative to the first
  alignas(64) Lanes squaredRadius;   ///< mm^2; 0 where the circle is not valid
};

/// Triples of the points (u, v), with repetition.
void drawTriples(const std::vector<float>& u, const std::vector<float>& v, Random& random,
                 CircleBlock& block);

/// Turns triples into circles (Yureidini's thesis, eq. 3.1). Valid are those with a radius in
/// [low, high] that hold the origin.
void circlesThrough(CircleBlock& block, float low, float high);

/// Points within `band` of the circle, by squared distances: low2 <= |p - centre|^2 <= high2.
int countInBand(const float* u, const float* v, std::size_t count, float centreU, float centreV,
                float low2, float high2);
/// Points within the band of a circle, one at a time: the reference for countInBand.
int countInBandReference(const float* u, const float* v, std::size_t count, float centreU,
                         float centreV, float low2, float high2);

}  // namespace lumen::convert
