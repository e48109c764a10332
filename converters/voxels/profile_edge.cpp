// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/profile_edge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lumen::convert {
namespace {

constexpr int kHalfWindow = kSamplesPerVoxel / 2;  // changes and levels are taken over one voxel
constexpr int kLevelReach =
    5 * kSamplesPerVoxel / 2;        // distance from an edge within which its levels are searched
constexpr double kLeastShare = 0.5;  // relative to the greatest change: weaker places are texture

/// The part of a profile that lies in the volume.
class Profile {
public:
  Profile(std::span<const float> values, int wall) : m_values(values), m_wall(wall) {
    m_begin = wall;
    while (m_begin > 0 && !std::isnan(at(m_begin - 1))) --m_begin;
    m_end = wall;
    while (m_end < static_cast<int>(values.size()) && !std::isnan(at(m_end))) ++m_end;
  }

  [[nodiscard]] double at(int i) const {
    return static_cast<double>(m_values[static_cast<std::size_t>(i)]);
  }
  [[nodiscard]] int first() const { return m_begin + kHalfWindow; }
  [[nodiscard]] int last() const { return m_end - 1 - kHalfWindow; }
  [[nodiscard]] double fall(int i) const { return at(i - kHalfWindow) - at(i + kHalfWindow); }
  [[nodiscard]] int fromWall(int i) const { return std::abs(i - m_wall); }

  /// The place nearest to the wall where sign * fall has a maximum of at least `least`; -1 if none.
  [[nodiscard]] int nearest(double sign, double least) const {
    int best = -1;
    for (int i = first(); i <= last(); ++i) {
      const double here = sign * fall(i);
      if (here < least || (i > first() && sign * fall(i - 1) > here) ||
          (i < last() && sign * fall(i + 1) >= here))
        continue;
      if (best < 0 || fromWall(i) < fromWall(best)) best = i;
    }
    return best;
  }

  /// Place of the maximum of sign * fall, in samples from the wall, by the parabola through `i` and
  /// its neighbours.
  [[nodiscard]] double peak(int i, double sign) const {
    if (i <= first() || i >= last()) return i - m_wall;
    const double before = sign * fall(i - 1), here = sign * fall(i), after = sign * fall(i + 1);
    const double bend = before - 2 * here + after;
    return i - m_wall + (bend < 0 ? 0.5 * (before - after) / bend : 0);
  }

  /// The greatest sign * mean over a voxel between the places `from` and `to`, times sign.
  [[nodiscard]] double level(int from, int to, double sign) const {
    from = std::clamp(from, first(), last());
    to = std::clamp(to, from, last());
    double sum = 0, best = 0;
    for (int k = -kHalfWindow; k < kHalfWindow; ++k) sum += at(from + k);
    best = sign * sum;
    for (int i = from; i < to; ++i) {
      sum += at(i + kHalfWindow) - at(i - kHalfWindow);
      best = std::max(best, sign * sum);
    }
    return sign * best / (2 * kHalfWindow);
  }

  /// Place where the profile passes `level` in the direction of `sign`, nearest to `edge`, in
  /// samples from the wall; the edge itself if there is none within the reach of the levels.
  [[nodiscard]] double crossing(int edge, double level, double sign) const {
    for (int away = 0; away <= kLevelReach; ++away)
      for (const int i : {edge - away, edge + away - 1}) {
        if (i < m_begin || i + 1 >= m_end) continue;
        const double before = sign * (at(i) - level), after = sign * (at(i + 1) - level);
        if (before >= 0 && after < 0) return i + before / (before - after) - m_wall;
      }
    return edge - m_wall;
  }

private:
  std::span<const float> m_values;
  int m_wall, m_begin = 0, m_end = 0;
};

}  // namespace

// Three voxels show both levels of an edge that lies up to a voxel off; half a radius serves wide
// vessels. The opposite wall lies beyond the axis; a level needs at least a voxel.
ProfileReach profileReach(double radius, double voxel) {
  const double reach = std::max(3 * voxel, 0.5 * radius);
  return {std::max(std::min(reach, radius), voxel), reach};
}

ProfileEdge findEdge(std::span<const float> values, std::size_t wall) {
  const Profile profile(values, static_cast<int>(wall));
  ProfileEdge edge;
  if (profile.last() - profile.first() < kSamplesPerVoxel) return edge;
  double greatest = 0;
  for (int i = profile.first(); i <= profile.last(); ++i)
    greatest = std::max(greatest, std::abs(profile.fall(i)));
  if (!(greatest > 0)) return edge;
  const int fall = profile.nearest(1, kLeastShare * greatest);
  const int rise = profile.nearest(-1, kLeastShare * greatest);
  const bool falls = fall >= 0 && (rise < 0 || profile.fromWall(fall) <=
                                                   profile.fromWall(rise) + kSamplesPerVoxel);
  const int place = falls ? fall : rise;
  if (place < 0) return edge;
  const double sign = falls ? 1 : -1;
  edge.kind = falls ? EdgeKind::Falls : EdgeKind::Rises;
  edge.inside = profile.level(place - kLevelReach, place - kHalfWindow, sign);
  edge.outside = profile.level(place + kHalfWindow, place + kLevelReach, -sign);
  edge.at = profile.crossing(place, edge.half(), sign);
  edge.steepest = profile.peak(place, sign);
  return edge;
}

FallWidth fallWidth(std::span<const double> fall, std::size_t near) {
  const std::size_t n = fall.size(), middle = n / 2;
  const auto first = fall.begin() + static_cast<std::ptrdiff_t>(middle - near);
  const auto at = static_cast<std::size_t>(
      std::max_element(first, first + static_cast<std::ptrdiff_t>(2 * near + 1)) - fall.begin());
  const double half = 0.5 * fall[at];
  if (!(half > 0)) return {at, 0};
  std::size_t right = at, left = at;
  while (right < n && fall[right] > half) ++right;
  while (left > 0 && fall[left] > half) --left;
  if (right + 1 >= n || left == 0) return {at, 0};
  const auto crossing = [&](std::size_t low, std::size_t high) {
    return (fall[high] - half) / (fall[high] - fall[low]);
  };
  return {at, static_cast<double>(right - left) - 2.0 + crossing(right, right - 1) +
                  crossing(left, left + 1)};
}

}  // namespace lumen::convert
