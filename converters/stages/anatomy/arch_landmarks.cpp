// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/arch_landmarks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/stages/anatomy/usual.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Nodes = std::vector<std::uint32_t>;
using Ways = VesselNetwork::Ways;
using WayCost = VesselNetwork::WayCost;

// Wide ranges about those of adults (S. Standring, Gray's Anatomy, for the course; A. Hager et
// al., "Diameters of the thoracic aorta throughout life as measured with helical computed
// tomography", Journal of Thoracic and Cardiovascular Surgery 123, 2002, for the taper). Lengths are
// in radii of the arch, but for this radius, which is that of a newborn or wider.
constexpr Usual kArchRadius{3, 25, 0.4};    // mm
constexpr Usual kTurn{120, 180, 15};        // degrees between the directions of both limbs
constexpr Usual kBackToLeft{10, 80, 10};    // of the way between both, degrees from backwards
constexpr Usual kLimbsApart{2.5, 12, 0.5};  // level
constexpr Usual kLimbDepth{1.5, 4, 0.25};   // of the shorter limb below the apex
constexpr Usual kTaper{0.5, 1.3, 0.1};      // radius of the limb behind over that before
constexpr Usual kBranchRadius{0, 0.75, 0.08};
constexpr double kDepth = 3;   // where limbs are compared
constexpr double kReach = 10;  // how far branches are looked at
constexpr double kLeastRise = 1.8, kLeastSlope = 0.35, kLeastRadius = 0.1;  // of a great vessel
constexpr double kOutside = 1.5,
                 kBeyond = 3;       // from its beginning: outside of the aorta, past the arch
constexpr double kOneOrigin = 0.5;  // vessels within it are ordered by their sides

class ArchSearch {
public:
  explicit ArchSearch(const VesselNetwork& network) : m_network(network) {}

  /// The arch of the tree that holds a node.
  ArchLandmarks at(std::uint32_t node) {
    m_arch = {};
    m_arch.course = fullestWay(fullestWay(node).back());
    if (m_arch.course.size() < 5) return {};
    measureLimbs();
    if (m_arch.plausible > 0) findVessels();
    return m_arch;
  }

private:
  [[nodiscard]] Vector3d place(std::size_t k) const { return m_network.position(m_arch.course[k]); }

  /// The way from a node that holds the most lumen.
  [[nodiscard]] Nodes fullestWay(std::uint32_t from) const {
    const Ways ways = m_network.waysFrom(from, {}, WayCost::Resistance);
    std::vector<double> lumen(ways.cost.size(), -1);
    lumen[from] = 0;
    std::uint32_t fullest = from;
    Nodes open;
    for (const std::uint32_t tip : ways.reached()) {
      for (std::uint32_t n = tip; lumen[n] < 0; n = ways.before[n]) open.push_back(n);
      for (; !open.empty(); open.pop_back()) {
        const std::uint32_t n = open.back(), before = ways.before[n];
        const double radius = m_network.radius(n);
        lumen[n] = lumen[before] + m_network.length(before, n) * radius * radius;
      }
      if (lumen[tip] > lumen[fullest]) fullest = tip;
    }
    return ways.to(fullest);
  }

  /// The nodes of the course within a length of one of them.
  [[nodiscard]] std::pair<std::size_t, std::size_t> around(std::size_t k, double length) const {
    std::size_t low = k, high = k;
    for (double run = 0; low > 0 && run < length; --low)
      run += m_network.length(m_arch.course[low], m_arch.course[low - 1]);
    for (double run = 0; high + 1 < m_arch.course.size() && run < length; ++high)
      run += m_network.length(m_arch.course[high], m_arch.course[high + 1]);
    return {low, high};
  }
  [[nodiscard]] double radiusAround(std::size_t k, double length) const {
    const auto [low, high] = around(k, length);
    return m_network.medianRadius(std::span(m_arch.course).subspan(low, high - low + 1));
  }
  [[nodiscard]] Vector3d directionAround(std::size_t k) const {
    const auto [low, high] = around(k, m_arch.radius);
    return place(high) - place(low);
  }

  void findApex() {
    const Nodes& course = m_arch.course;
    const auto highest = std::max_element(course.begin(), course.end(), [&](auto a, auto b) {
      return m_network.position(a).z() < m_network.position(b).z();
    });
    m_arch.apex = static_cast<std::size_t>(highest - course.begin());
    m_arch.radius = radiusAround(m_arch.apex, kDepth * m_network.radius(*highest));
    const double low = place(m_arch.apex).z() - kDepth * m_arch.radius;
    for (m_arch.foot = m_arch.apex; m_arch.foot > 0 && place(m_arch.foot).z() > low;) --m_arch.foot;
    for (m_arch.end = m_arch.apex; m_arch.end + 1 < course.size() && place(m_arch.end).z() > low;)
      ++m_arch.end;
  }

  void measureLimbs() {
    findApex();
    if (place(m_arch.foot).y() > place(m_arch.end).y()) {
      std::reverse(m_arch.course.begin(), m_arch.course.end());
      findApex();
    }
    if (m_arch.foot == m_arch.apex || m_arch.end == m_arch.apex || !(m_arch.radius > 0)) return;
    constexpr double kDegrees = 180 / std::numbers::pi;
    const Vector3d up = directionAround(m_arch.foot), down = directionAround(m_arch.end);
    const Vector3d across = place(m_arch.end) - place(m_arch.foot);
    const double turn = std::atan2(up.cross(down).norm(), up.dot(down)) * kDegrees;
    const double depth =
        place(m_arch.apex).z() - std::max(place(m_arch.foot).z(), place(m_arch.end).z());
    if (!(up.z() > 0) || !(down.z() < 0)) return;
    m_arch.plausible =
        kArchRadius(m_arch.radius) * kTurn(turn) *
        kBackToLeft(std::atan2(across.x(), across.y()) * kDegrees) *
        kLimbsApart(across.head<2>().norm() / m_arch.radius) * kLimbDepth(depth / m_arch.radius) *
        kTaper(radiusAround(m_arch.end, m_arch.radius) / radiusAround(m_arch.foot, m_arch.radius));
  }

  void findVessels() {
    const NodeSet isCourse = m_network.setOf(m_arch.course);
    for (std::size_t k = m_arch.foot; k <= m_arch.end; ++k)
      for (const std::uint32_t first : m_network.neighbours(m_arch.course[k]))
        if (!isCourse[first]) findVessel(k, first, isCourse);
    // from one origin the right one comes first
    std::vector<GreatVessel>& vessels = m_arch.vessels;
    for (std::size_t i = 1; i < vessels.size(); ++i)
      if ((place(vessels[i].place) - place(vessels[i - 1].place)).norm() <
              kOneOrigin * m_arch.radius &&
          vessels[i].left < vessels[i - 1].left)
        std::swap(vessels[i], vessels[i - 1]);
  }

  void findVessel(std::size_t k, std::uint32_t first, const NodeSet& closed) {
    const double unit = m_arch.radius;
    const Ways ways = m_network.waysFrom(first, closed, WayCost::Length, kReach * unit);
    std::uint32_t top = first, far = first;
    for (const std::uint32_t n : ways.reached()) {
      if (m_network.position(n).z() > m_network.position(top).z()) top = n;
      if (ways.cost[n] > ways.cost[far]) far = n;
    }
    const auto radiusTo = [&](std::uint32_t tip) {
      Nodes nodes;
      for (const std::uint32_t n : ways.to(tip))
        if (ways.cost[n] > kOutside * unit && ways.cost[n] < kBeyond * unit) nodes.push_back(n);
      return m_network.medianRadius(nodes);
    };
    m_arch.plausible *= kBranchRadius(radiusTo(far) / unit);
    const Vector3d origin = place(k);
    if (m_network.position(top).z() - origin.z() < kLeastRise * unit) return;
    Vector3d past = m_network.position(top);
    for (const std::uint32_t n : ways.to(top))
      if (ways.cost[n] < kBeyond * unit) past = m_network.position(n);
    GreatVessel vessel{k, first, radiusTo(top), past.x()};
    if ((past - origin).normalized().z() > kLeastSlope && vessel.radius > kLeastRadius * unit)
      m_arch.vessels.push_back(vessel);
  }

  const VesselNetwork& m_network;
  ArchLandmarks m_arch;
};

}  // namespace

ArchLandmarks findArch(const VesselNetwork& network, std::size_t nodeCount) {
  constexpr double kLeastSeed = 2;  // mm: no arch is that thin (kArchRadius)
  ArchLandmarks best;
  NodeSet isSeen(nodeCount, false);
  for (std::uint32_t n = 0; n < nodeCount; ++n) {
    if (isSeen[n] || network.radius(n) < kLeastSeed) continue;
    for (const std::uint32_t m : network.waysFrom(n).reached()) isSeen[m] = true;
    ArchLandmarks arch = ArchSearch(network).at(n);
    if (arch.plausible > best.plausible) best = std::move(arch);
  }
  return best;
}

}  // namespace lumen::convert
