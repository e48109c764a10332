// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Nodes = std::vector<std::uint32_t>;
using Ways = VesselNetwork::Ways;
using WayCost = VesselNetwork::WayCost;

constexpr std::uint32_t kNone = VesselNetwork::kNone;

// Wide ranges about those of adults (S. Kamath, "Observations on the length and diameter of vessels
// forming the circle of Willis", Journal of Anatomy 133, 1981). Lengths and radii in mm.
constexpr Usual kInletRadius{1.5, 3.2, 0.4}, kInletsApart{18, 75, 6};
constexpr Usual kInletRatio{1, 1.3, 0.2};                              // of the two radii
constexpr Usual kInletDepth{0, 0.25, 0.15}, kInletLevel{0, 0.3, 0.2};  // shares of their distance
constexpr Usual kA1Length{8, 26, 5}, kA1Radius{0.5, 1.6, 0.2};
constexpr Usual kA1Straight{0.6, 1, 0.15};  // chord over length
constexpr Usual kTerminusAside{5, 22, 3}, kTerminusAbove{15, 80, 8};
constexpr Usual kTerminiApart{16, 42, 4}, kTerminiUneven{0, 8, 3};
constexpr Usual kTerminusMirrored{0, 6, 2};
constexpr double kTerminusReach = 10;  // of the mirrored place
constexpr double kOneTerminus = 0.8;   // plausibility where one side alone has an A1
constexpr double kLeastInlet = 1.2, kLeastBasilar = 0.8;  // radii that are looked at
constexpr double kInletReach = 5;                         // whose median radius is an inlet's
// Half the width of the strip about the midplane that an A1 leads to: that of the inlets, of the circle.
constexpr std::array<double, 2> kStrips{12, 5};
constexpr double kRiseReach = 10, kInletRise = 6;
constexpr double kAboveInlet = 15;  // of what a carotid artery feeds
constexpr double kSiphon = 12;      // length of a carotid artery before its end
constexpr double kA1Reach = 40;     // how far that is looked for

class LandmarkSearch : CirclePlaces {
public:
  LandmarkSearch(const VesselNetwork& network, const std::vector<formats::Branch>& branches)
      : CirclePlaces(network), m_branches(branches) {
    m_marks.half[1].letter = 'L';
    m_marks.half[1].sign = 1;
  }

  CircleLandmarks find() {
    if (findCarotids()) {
      findBasilar();
      findTermini();
    }
    return m_marks;
  }

private:
  /// The roots, and behind them the ends from which a vessel rises: a search may have begun elsewhere.
  void findInlets() {
    Nodes inlets;
    for (const formats::Branch& branch : m_branches)
      if (branch.parentNode == formats::kNoParent) inlets.push_back(branch.firstNode);
    const NodeSet isRoot = m_network.setOf(inlets);
    for (const std::uint32_t n : m_network.ends())
      if (!isRoot[n] && riseFrom(n) > kInletRise) inlets.push_back(n);
    for (const std::uint32_t n : inlets) {
      const Ways near = m_network.waysFrom(n, {}, WayCost::Length, kInletReach);
      m_inlets.emplace_back(m_network.medianRadius(near.reached()), n);
    }
  }

  /// Height, mm, that is gained along kRiseReach.
  [[nodiscard]] double riseFrom(std::uint32_t n) const {
    double rise = 0;
    for (const std::uint32_t m : m_network.waysFrom(n, {}, WayCost::Length, kRiseReach).reached())
      rise = std::max(rise, z(m) - z(n));
    return rise;
  }

  /// Two inlets of like width, side by side.
  bool findCarotids() {
    findInlets();
    double best = 0;
    for (const auto& [radius, one] : m_inlets)
      for (const auto& [otherRadius, other] : m_inlets) {
        const Vector3d way = at(other) - at(one);
        const double thin = std::min(radius, otherRadius), wide = std::max(radius, otherRadius);
        if (!(way.x() > 0) || thin < kLeastInlet) continue;
        const double apart = way.norm();
        const double pair = kInletDepth(std::abs(way.y()) / apart) *
                            kInletLevel(std::abs(way.z()) / apart) * kInletRatio(wide / thin) *
                            kInletsApart(apart) * kInletRadius(thin) * kInletRadius(wide);
        if (!(pair > best)) continue;
        best = pair;
        m_marks.half[0].inlet = one;
        m_marks.half[1].inlet = other;
        m_marks.middle = 0.5 * (x(one) + x(other));
      }
    m_marks.plausible = best;
    return best > 0;
  }

  /// The widest inlet between the carotid arteries, and not before them.
  void findBasilar() {
    const std::uint32_t right = m_marks.half[0].inlet, left = m_marks.half[1].inlet;
    double widest = kLeastBasilar;
    for (const auto& [radius, n] : m_inlets) {
      if (n == right || n == left || radius < widest) continue;
      if (std::abs(x(n) - m_marks.middle) > 0.35 * (x(left) - x(right)) ||
          y(n) < std::min(y(right), y(left)) - 2 || std::abs(z(n) - z(right)) > 25)
        continue;
      widest = radius;
      m_marks.basilar = n;
    }
  }

  void findTermini() {
    findCourses();
    // a head that leans has its midplane at the circle elsewhere than at the inlets
    for (const double strip : kStrips) {
      for (HalfCircle& half : m_marks.half) findTerminus(half, strip);
      if (m_marks.isPair())
        m_marks.middle = 0.5 * (x(m_marks.left().end()) + x(m_marks.right().end()));
    }
    if (m_marks.isPair()) {
      const Vector3d way = at(m_marks.left().end()) - at(m_marks.right().end());
      m_marks.plausible *= kTerminiApart(way.norm()) * kTerminiUneven(std::abs(way.z())) *
                           kTerminiUneven(std::abs(way.y()));
    } else {
      m_marks.plausible *= m_marks.right().isFound() || m_marks.left().isFound() ? kOneTerminus : 0;
      mirrorTerminus();
    }
  }

  /// Without an A1 the carotid artery of a side ends where its course, which rose, turns aside, near
  /// the place where that of the other side does, as seen from the inlet of each.
  void mirrorTerminus() {
    HalfCircle& half = m_marks.half[m_marks.right().isFound() ? 1 : 0];
    const HalfCircle& other = m_marks.half[m_marks.right().isFound() ? 0 : 1];
    if (!other.isFound()) return;
    Vector3d way = at(other.end()) - at(other.inlet);
    way.x() = -way.x();
    const Vector3d place = at(half.inlet) + way;
    double nearest = kTerminusReach, highest = 0;
    for (std::size_t k = 0; k < half.course.size(); ++k) {
      const std::uint32_t n = half.course[k];
      const double distance = (at(n) - place).norm(), turn = z(n) - aside(n, half);
      if (distance > kTerminusReach) continue;
      if (nearest == kTerminusReach || turn > highest) {
        highest = turn;
        half.terminus = k;
      }
      nearest = std::min(nearest, distance);
    }
    if (nearest < kTerminusReach) half.plausible = other.plausible * kTerminusMirrored(nearest);
  }

  /// The courses to the most lateral tip that each carotid artery feeds: more easily than the others
  /// do.
  void findCourses() {
    std::vector<Ways> flow;
    for (const HalfCircle& half : m_marks.half)
      flow.push_back(m_network.waysFrom(half.inlet, {}, WayCost::Resistance));
    const bool hasBasilar = m_marks.basilar != kNone;
    if (hasBasilar) flow.push_back(m_network.waysFrom(m_marks.basilar, {}, WayCost::Resistance));
    for (std::size_t h = 0; h < 2; ++h) {
      HalfCircle& half = m_marks.half[h];
      std::uint32_t tip = kNone;
      for (const std::uint32_t n : m_network.ends()) {
        const double own = flow[h].cost[n];
        const bool isOwn =
            flow[h].reach(n) && own < flow[1 - h].cost[n] && (!hasBasilar || own < flow[2].cost[n]);
        if (!isOwn || z(n) < z(half.inlet) + kAboveInlet) continue;
        if (tip == kNone || aside(n, half) > aside(tip, half)) tip = n;
      }
      if (tip != kNone) half.course = m_network.waysFrom(half.inlet).to(tip);
    }
  }

  /// The place of a course from which a way leads to the midline that is like the first segment of
  /// an anterior cerebral artery.
  void findTerminus(HalfCircle& half, double strip) {
    half.plausible = 0;
    half.a1.clear();
    const NodeSet isCourse = m_network.setOf(half.course);
    double run = 0;
    for (std::size_t k = 1; k < half.course.size(); ++k) {
      const std::uint32_t fork = half.course[k];
      run += m_network.length(half.course[k - 1], fork);
      if (run < kSiphon) continue;
      for (const std::uint32_t first : m_network.neighbours(fork)) {
        if (isCourse[first]) continue;
        const Nodes way = wayToMidline(fork, first, strip, isCourse);
        if (way.empty()) continue;
        const double length = m_network.length(fork, first) + m_network.lengthOf(way);
        const double plausible =
            kA1Length(length) * kA1Straight((at(way.back()) - at(fork)).norm() / length) *
            kA1Radius(m_network.medianRadius(way)) * kTerminusAside(aside(fork, half)) *
            kTerminusAbove(z(fork) - z(half.inlet));
        if (!(plausible > half.plausible)) continue;
        half.plausible = plausible;
        half.terminus = k;
        half.a1 = way;
      }
    }
  }

  /// The shortest way from a fork through `first` to the strip about the midplane before it.
  [[nodiscard]] Nodes wayToMidline(std::uint32_t fork, std::uint32_t first, double strip,
                                   const NodeSet& closed) const {
    const Ways ways = m_network.waysFrom(first, closed, WayCost::Length, kA1Reach);
    std::uint32_t best = kNone;
    for (const std::uint32_t n : ways.reached()) {
      if (std::abs(x(n) - m_marks.middle) > strip || y(n) > y(fork) + 2 || z(n) < z(fork) - 8)
        continue;
      if (best == kNone || ways.cost[n] < ways.cost[best]) best = n;
    }
    return best == kNone ? Nodes{} : ways.to(best);
  }

  const std::vector<formats::Branch>& m_branches;
  std::vector<std::pair<double, std::uint32_t>> m_inlets;  // radius and node
};

}  // namespace

CircleLandmarks findCircleLandmarks(const VesselNetwork& network,
                                    const std::vector<formats::Branch>& branches) {
  return LandmarkSearch(network, branches).find();
}

}  // namespace lumen::convert
