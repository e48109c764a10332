// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_landmarks.h"

#include <utility>

#include <Eigen/Core>

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
constexpr double kOneTerminus = 0.8;  // plausibility where one side alone has an A1
constexpr double kLeastInlet = 1.2, kLeastBasilar = 0.8;  // radii that are looked at
constexpr double kInletReach = 5;                         // whose median radius is an inlet's
// Half the width of the strip about the midplane that an A1 leads to: that of the inlets, of the circle.
constexpr std::array<double, 2> kStrips{12, 5};
constexpr double kAboveInlet = 15;  // of what a carotid artery feeds
constexpr double kSiphon = 12;      // length of a carotid artery before its end
constexpr double kA1Reach = 40;     // how far that is looked for

class LandmarkSearch {
public:
  LandmarkSearch(const VesselNetwork& network, const std::vector<formats::Branch>& branches)
      : m_network(network), m_branches(branches) {
    m_found.half[1].letter = 'L';
    m_found.half[1].sign = 1;
  }

  CircleLandmarks find() {
    if (findCarotids()) {
      findBasilar();
      findTermini();
    }
    return m_found;
  }

private:
  [[nodiscard]] Vector3d at(std::uint32_t n) const { return m_network.position(n); }
  [[nodiscard]] double x(std::uint32_t n) const { return at(n).x(); }
  [[nodiscard]] double y(std::uint32_t n) const { return at(n).y(); }
  [[nodiscard]] double z(std::uint32_t n) const { return at(n).z(); }
  [[nodiscard]] double aside(std::uint32_t n, const HalfCircle& half) const {
    return half.sign * (x(n) - m_found.middle);
  }

  /// Two inlets of like width, side by side.
  bool findCarotids() {
    for (const formats::Branch& branch : m_branches) {
      if (branch.parentNode != formats::kNoParent) continue;
      const std::uint32_t root = branch.firstNode;
      const Ways near = m_network.waysFrom(root, {}, WayCost::Length, kInletReach);
      m_inlets.emplace_back(m_network.medianRadius(near.reached()), root);
    }
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
        m_found.half[0].inlet = one;
        m_found.half[1].inlet = other;
        m_found.middle = 0.5 * (x(one) + x(other));
      }
    m_found.plausible = best;
    return best > 0;
  }

  /// The widest inlet between the carotid arteries, and not before them.
  void findBasilar() {
    const std::uint32_t right = m_found.half[0].inlet, left = m_found.half[1].inlet;
    double widest = kLeastBasilar;
    for (const auto& [radius, n] : m_inlets) {
      if (n == right || n == left || radius < widest) continue;
      if (std::abs(x(n) - m_found.middle) > 0.35 * (x(left) - x(right)) ||
          y(n) < std::min(y(right), y(left)) - 2 || std::abs(z(n) - z(right)) > 25)
        continue;
      widest = radius;
      m_found.basilar = n;
    }
  }

  void findTermini() {
    findCourses();
    // a head that leans has its midplane at the circle elsewhere than at the inlets
    for (const double strip : kStrips) {
      for (HalfCircle& half : m_found.half) findTerminus(half, strip);
      if (m_found.isPair())
        m_found.middle = 0.5 * (x(m_found.left().end()) + x(m_found.right().end()));
    }
    if (m_found.isPair()) {
      const Vector3d way = at(m_found.left().end()) - at(m_found.right().end());
      m_found.plausible *= kTerminiApart(way.norm()) * kTerminiUneven(std::abs(way.z())) *
                           kTerminiUneven(std::abs(way.y()));
    } else {
      m_found.plausible *= m_found.right().isFound() || m_found.left().isFound() ? kOneTerminus : 0;
    }
  }

  /// The courses to the most lateral tip that each carotid artery feeds: more easily than the others
  /// do.
  void findCourses() {
    std::vector<Ways> flow;
    for (const HalfCircle& half : m_found.half)
      flow.push_back(m_network.waysFrom(half.inlet, {}, WayCost::Resistance));
    const bool hasBasilar = m_found.basilar != kNone;
    if (hasBasilar) flow.push_back(m_network.waysFrom(m_found.basilar, {}, WayCost::Resistance));
    for (std::size_t h = 0; h < 2; ++h) {
      HalfCircle& half = m_found.half[h];
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
      if (std::abs(x(n) - m_found.middle) > strip || y(n) > y(fork) + 2 || z(n) < z(fork) - 8)
        continue;
      if (best == kNone || ways.cost[n] < ways.cost[best]) best = n;
    }
    return best == kNone ? Nodes{} : ways.to(best);
  }

  const VesselNetwork& m_network;
  const std::vector<formats::Branch>& m_branches;
  std::vector<std::pair<double, std::uint32_t>> m_inlets;  // radius and node
  CircleLandmarks m_found;
};

}  // namespace

CircleLandmarks findCircleLandmarks(const VesselNetwork& network,
                                    const std::vector<formats::Branch>& branches) {
  return LandmarkSearch(network, branches).find();
}

}  // namespace lumen::convert
