// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/steepest_fall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "converters/base/simd.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kFallLanes = 8;
using FallLanes [[gnu::vector_size(4 * kFallLanes)]] = float;
using LooseFallLanes [[gnu::vector_size(4 * kFallLanes), gnu::aligned(4), gnu::may_alias]] = float;
using FallPlaces [[gnu::vector_size(4 * kFallLanes)]] = std::int32_t;

struct PlacedFall {
  std::size_t place = 0;
  float strength = 0;
};

/// The first of the greatest falls at the places 1 .. end - 2; 0 if nothing falls.
LUMEN_SIMD_CLONES
PlacedFall greatestFall(const float* values, std::size_t end, float sign) {
  FallLanes strongest{};
  FallPlaces places{}, here{};
  for (std::size_t l = 0; l < kFallLanes; ++l) here[l] = static_cast<std::int32_t>(l) + 1;
  std::size_t i = 1;
  for (; i + kFallLanes < end; i += kFallLanes) {
    const FallLanes before = *reinterpret_cast<const LooseFallLanes*>(values + i - 1);
    const FallLanes after = *reinterpret_cast<const LooseFallLanes*>(values + i + 1);
    const FallLanes fall = sign * (before - after);
    const FallPlaces isMore = fall > strongest;
    strongest = isMore ? fall : strongest;
    places = isMore ? here : places;
    here += static_cast<std::int32_t>(kFallLanes);
  }
  PlacedFall best;
  for (std::size_t l = 0; l < kFallLanes; ++l) {
    const auto place = static_cast<std::size_t>(places[l]);
    const bool isFirst = strongest[l] == best.strength && place < best.place;
    if (strongest[l] > best.strength || isFirst) best = {place, strongest[l]};
  }
  for (; i + 1 < end; ++i) {
    const float fall = sign * (values[i - 1] - values[i + 1]);
    if (fall > best.strength) best = {i, fall};
  }
  return best;
}

}  // namespace

SteepestFall steepestFall(std::span<const float> values, float sign) {
  if (values.empty() || std::isnan(values.front())) return {};
  std::size_t inside = values.size();
  if (std::isnan(values.back()))
    inside = static_cast<std::size_t>(
        std::find_if(values.begin(), values.end(), [](float v) { return std::isnan(v); }) -
        values.begin());
  const auto [best, strongest] = greatestFall(values.data(), inside, sign);
  // a parabola needs differences on both sides; at a face of the volume the last is not trusted
  const std::size_t end = inside < values.size() ? inside - 1 : inside;
  if (best < 2 || best + 2 >= end) return {};
  const double before = static_cast<double>(sign * (values[best - 2] - values[best]));
  const double after = static_cast<double>(sign * (values[best] - values[best + 2]));
  const double bend = before - 2.0 * static_cast<double>(strongest) + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0.0;
  constexpr double kMostShift = 1.0;  // samples: the maximum is between the best one's neighbours
  return {static_cast<double>(best) + std::clamp(shift, -kMostShift, kMostShift), strongest};
}

}  // namespace lumen::convert
