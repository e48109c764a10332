// SPDX-License-Identifier: Apache-2.0
// Declared in rays.h.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "converters/base/simd.h"
#include "converters/stages/tracking/cylinders/rays.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kFallLanes = 8;
using FallLanes [[gnu::vector_size(4 * kFallLanes)]] = float;
using LooseFallLanes [[gnu::vector_size(4 * kFallLanes), gnu::aligned(4), gnu::may_alias]] = float;
using FallPlaces [[gnu::vector_size(4 * kFallLanes)]] = std::int32_t;

struct PlacedFall {
  std::size_t place = 0;
  float strength = 0;
  std::size_t end = 0;  ///< places before it count
};

/// The first of the greatest falls from a place on, before the first that is not known.
PlacedFall greatestFrom(std::size_t first, std::span<const float> values, float sign,
                        PlacedFall best) {
  best.end = values.size();
  for (std::size_t i = first; i + 1 < best.end; ++i) {
    const float fall = sign * (values[i - 1] - values[i + 1]);
    if (std::isnan(fall)) best.end = i;
    if (fall > best.strength) {
      best.place = i;
      best.strength = fall;
    }
  }
  return best;
}

/// As greatestFrom() from the second sample on, in lanes. Where a fall is not known, it begins anew
/// without them.
LUMEN_SIMD_CLONES
PlacedFall greatestFall(std::span<const float> values, float sign) {
  FallLanes strongest{};
  FallPlaces places{}, here{}, isUnknown{};
  for (std::size_t l = 0; l < kFallLanes; ++l) here[l] = static_cast<std::int32_t>(l) + 1;
  std::size_t i = 1;
  for (; i + kFallLanes < values.size(); i += kFallLanes) {
    const FallLanes before = *reinterpret_cast<const LooseFallLanes*>(values.data() + i - 1);
    const FallLanes after = *reinterpret_cast<const LooseFallLanes*>(values.data() + i + 1);
    const FallLanes fall = sign * (before - after);
    const FallPlaces isMore = fall > strongest;
    strongest = isMore ? fall : strongest;
    places = isMore ? here : places;
    isUnknown |= fall != fall;
    here += static_cast<std::int32_t>(kFallLanes);
  }
  PlacedFall best;
  for (std::size_t l = 0; l < kFallLanes; ++l) {
    if (isUnknown[l] != 0) return greatestFrom(1, values, sign, {});
    const auto place = static_cast<std::size_t>(places[l]);
    const bool isFirst = strongest[l] == best.strength && place < best.place;
    if (strongest[l] > best.strength || isFirst) best = {place, strongest[l]};
  }
  return greatestFrom(i, values, sign, best);
}

}  // namespace

SteepestFall steepestFall(std::span<const float> values, float sign) {
  const auto [best, strongest, end] = greatestFall(values, sign);
  // a parabola needs a difference on either side of the best one
  if (best < 2 || best + 2 >= end) return {};
  const double before = static_cast<double>(sign * (values[best - 2] - values[best]));
  const double after = static_cast<double>(sign * (values[best] - values[best + 2]));
  const double bend = before - 2.0 * static_cast<double>(strongest) + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0.0;
  return {static_cast<double>(best) + shift, strongest};
}

}  // namespace lumen::convert
