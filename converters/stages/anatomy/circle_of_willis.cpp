// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_of_willis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "converters/stages/anatomy/artery_stretches.h"
#include "converters/stages/anatomy/circle_landmarks.h"
#include "converters/stages/anatomy/vessel_network.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Nodes = std::vector<std::uint32_t>;
using Ways = VesselNetwork::Ways;

constexpr Usual kMcaAside{14, 60, 5};
constexpr Usual kAcomLength{0.5, 8, 2}, kAcomAside{0, 5, 2};
constexpr Usual kBasilarAside{0, 7, 3}, kBasilarBehind{6, 32, 4}, kBasilarLength{8, 45, 6},
    kBasilarUneven{0, 20, 5}, kBasilarRadius{0.9, 2.4, 0.3};
constexpr Usual kPcaAside{8, 40, 4};
constexpr Usual kPcomLength{5, 28, 4}, kPcomRadius{0.2, 1.4, 0.2};
constexpr Usual kTrunksApart{1.5, 15, 0.7};
constexpr double kForkBehindA1 = 12;  // of the A2 that one A1 feeds
constexpr double kLeastAcross = 1;    // of an anterior communicating artery
constexpr double kTrunk = 10;         // length of an A2, of which it rises or advances kTrunkRise
constexpr double kTrunkRise = 8, kTrunkApart = 20;
constexpr double kFetalAside = 8,
                 kFetalBehind = 12;  // of the end of a PCA, from the carotid artery
constexpr double kTouchGap = 2;      // around the place where two ACA touch
constexpr double kForkGap = 4;       // around the end of a basilar artery without a fork

class CircleNames : CirclePlaces {
public:
  CircleNames(const formats::CenterlineTree& tree, const VesselNetwork& network)
      : CirclePlaces(network, findCircleLandmarks(network, tree.branches)),
        m_tree(tree),
        m_name(tree.nodeCount()),
        m_plausible(tree.nodeCount(), 0) {}

  std::vector<ArteryStretch> find() {
    if (!(m_marks.plausible > 0)) return {};
    for (const HalfCircle& half : m_marks.half)
      if (half.isFound()) nameCarotid(half);
    nameAnterior();
    namePosterior();
    return stretchesOf(m_tree, m_name, m_plausible);
  }

private:
  void set(const Nodes& nodes, const std::string& name, double plausible) {
    for (const std::uint32_t n : nodes) {
      m_name[n] = name;
      m_plausible[n] = plausible;
    }
  }
  void setFree(const Nodes& nodes, const std::string& name, double plausible) {
    for (const std::uint32_t n : nodes)
      if (m_name[n].empty()) set({n}, name, plausible);
  }

  /// The course to the terminus, and all that hangs on the course behind it.
  void nameCarotid(const HalfCircle& half) {
    const double plausible = m_marks.plausible * half.plausible;
    const auto end = half.course.begin() + static_cast<std::ptrdiff_t>(half.terminus);
    set(Nodes(half.course.begin(), end + 1), half.name("ICA"), plausible);
    if (end + 1 == half.course.end()) return;
    const Ways beyond = m_network.waysFrom(*(end + 1), m_network.setOf(Nodes{*end}));
    const bool isShared =
        (half.hasA1() && beyond.reach(half.a1.front())) || beyond.reach(m_marks.half[0].inlet) ||
        beyond.reach(m_marks.half[1].inlet) ||
        (m_marks.basilar != VesselNetwork::kNone && beyond.reach(m_marks.basilar));
    if (isShared) return;
    setFree(beyond.reached(), half.name("MCA"),
            plausible * kMcaAside(aside(half.course.back(), half) - aside(*end, half)));
  }

  /// The courses of both carotid arteries, which ways of other arteries do not enter.
  [[nodiscard]] NodeSet courses() const {
    Nodes nodes;
    for (const HalfCircle& half : m_marks.half)
      nodes.insert(nodes.end(), half.course.begin(), half.course.end());
    return m_network.setOf(nodes);
  }

  void nameAnterior() {
    const NodeSet closed = courses();
    const HalfCircle &right = m_marks.right(), &left = m_marks.left();
    if (m_marks.isPair()) {
      const Ways ways = m_network.waysFrom(right.a1.front(), closed);
      if (ways.reach(left.a1.front())) return nameJoined(ways.to(left.a1.front()), closed);
    }
    for (const HalfCircle& half : m_marks.half) {
      if (!half.hasA1()) continue;
      const Nodes all = m_network.waysFrom(half.a1.front(), closed).reached();
      const bool crosses = std::any_of(all.begin(), all.end(), [&](std::uint32_t n) {
        return aside(n, half) < -4 || n == m_marks.basilar;
      });
      // beyond the midline it may feed both sides
      set(m_marks.isPair() && !crosses ? all : half.a1, half.name("ACA"),
          m_marks.plausible * half.plausible);
      if (!m_marks.isPair()) nameFedAcross(half, closed);
    }
  }

  /// An A2 that leaves the way between both carotid arteries.
  struct Trunk {
    std::size_t place = 0;  ///< on the way
    Nodes nodes;
    bool isOne = false;  ///< and not two side by side
    std::uint32_t first = VesselNetwork::kNone;
  };

  [[nodiscard]] std::vector<Trunk> trunksOn(const Nodes& way, NodeSet closed) const {
    for (const std::uint32_t n : way) closed[n] = true;
    std::vector<Trunk> trunks;
    for (std::size_t k = 0; k < way.size(); ++k)
      for (const std::uint32_t first : m_network.neighbours(way[k])) {
        if (closed[first]) continue;
        const Ways ways = m_network.waysFrom(first, closed);
        Trunk trunk{k, ways.reached(), true, first};
        double longest = 0, rise = 0;
        int abreast = 0;
        for (const std::uint32_t n : trunk.nodes) {
          longest = std::max(longest, ways.cost[n]);
          rise = std::max({rise, z(n) - z(way[k]), y(way[k]) - y(n)});
          const std::uint32_t before = ways.before[n];
          if (before != VesselNetwork::kNone && ways.cost[n] >= kTrunkApart &&
              ways.cost[before] < kTrunkApart)
            ++abreast;
        }
        trunk.isOne = abreast <= 1;
        if (longest > kTrunk && rise > kTrunkRise) trunks.push_back(std::move(trunk));
      }
    return trunks;
  }

  /// Both anterior cerebral arteries along the way between the carotid arteries. The anterior
  /// communicating artery is what lies between the trunks that leave it, one on each side.
  void nameJoined(const Nodes& way, const NodeSet& closed) {
    const HalfCircle &right = m_marks.right(), &left = m_marks.left();
    const double plausible = m_marks.plausible * std::min(right.plausible, left.plausible);
    const std::vector<Trunk> trunks = trunksOn(way, closed);
    if (trunks.empty()) return;
    const std::size_t low = trunks.front().place, high = trunks.back().place;
    const auto part = [&](std::size_t from, std::size_t to) {
      return Nodes(way.begin() + static_cast<std::ptrdiff_t>(from),
                   way.begin() + static_cast<std::ptrdiff_t>(to));
    };
    // where both touch, the communicating artery is not to be seen
    const auto apart = [&](Nodes nodes) {
      std::erase_if(nodes, [&](std::uint32_t n) {
        return high == low && (at(n) - at(way[low])).norm() < kTouchGap;
      });
      return nodes;
    };
    set(apart(part(0, low + 1)), right.name("ACA"), plausible);
    set(apart(part(high, way.size())), left.name("ACA"), plausible);
    if (high == low || trunks.size() != 2 || !trunks.front().isOne || !trunks.back().isOne) return;
    if (high > low + 1)
      set(part(low + 1, high), "Acom",
          plausible * kAcomLength(m_network.lengthOf(part(low, high + 1))) *
              kAcomAside(std::abs(x(way[low]) - m_marks.middle)) *
              kAcomAside(std::abs(x(way[high]) - m_marks.middle)));
    set(trunks.front().nodes, right.name("ACA"), plausible);
    set(trunks.back().nodes, left.name("ACA"), plausible);
  }

  /// Both anterior cerebral arteries behind the one A1 that there is. The one that goes to the other
  /// side begins with the anterior communicating artery, up to where it turns forwards or up.
  void nameFedAcross(const HalfCircle& half, NodeSet closed) {
    const Ways ways = m_network.waysFrom(half.a1.front(), closed);
    if (m_marks.basilar != VesselNetwork::kNone && ways.reach(m_marks.basilar)) return;
    std::uint32_t tip = half.a1.back();
    for (const std::uint32_t n : m_network.ends())
      if (ways.reach(n) && ways.cost[n] > ways.cost[tip]) tip = n;
    const Nodes way = ways.to(tip);
    std::vector<Trunk> trunks = trunksOn(way, closed);
    std::erase_if(trunks, [&](const Trunk& trunk) {
      return ways.cost[way[trunk.place]] > ways.cost[half.a1.back()] + kForkBehindA1;
    });
    if (trunks.size() != 1 || !trunks[0].isOne) return;
    const auto fork = way.begin() + static_cast<std::ptrdiff_t>(trunks[0].place);
    for (auto n = way.begin(); n <= fork; ++n) closed[*n] = true;
    Ways own = m_network.waysFrom(*(fork + 1), closed),
         other = m_network.waysFrom(trunks[0].first, closed);
    if (half.sign * (meanX(own) - meanX(other)) < 0) std::swap(own, other);
    const Nodes across = acrossTo(*fork, other, -half.sign);
    if (across.empty()) return;
    const double plausible =
        m_marks.plausible * half.plausible * kTrunksApart(half.sign * (meanX(own) - meanX(other)));
    set(Nodes(way.begin(), fork + 1), half.name("ACA"), plausible);
    set(own.reached(), half.name("ACA"), plausible);
    set(other.reached(), otherThan(half).name("ACA"), plausible);
    set(across, "Acom",
        plausible *
            kAcomLength(m_network.length(*fork, across.front()) + m_network.lengthOf(across)));
  }

  [[nodiscard]] const HalfCircle& otherThan(const HalfCircle& half) const {
    return m_marks.half[half.letter == 'R' ? 1 : 0];
  }

  /// The mean of x at the beginning of an A2, mm.
  [[nodiscard]] double meanX(const Ways& trunk) const {
    double sum = 0;
    int count = 0;
    for (const std::uint32_t n : trunk.reached())
      if (trunk.cost[n] < kTrunkApart) {
        sum += x(n);
        ++count;
      }
    return sum / std::max(count, 1);
  }

  /// The beginning of an A2 up to where it goes no more to a side than it rises or advances, behind a
  /// fork; empty if it does not go to that side.
  [[nodiscard]] Nodes acrossTo(std::uint32_t fork, const Ways& trunk, double sign) const {
    std::uint32_t tip = VesselNetwork::kNone;
    for (const std::uint32_t n : trunk.reached())
      if (tip == VesselNetwork::kNone || trunk.cost[n] > trunk.cost[tip]) tip = n;
    const auto gain = [&](std::uint32_t n) {
      return sign * (x(n) - x(fork)) - std::max({z(n) - z(fork), y(fork) - y(n), 0.0});
    };
    const Nodes way = trunk.to(tip);
    const auto turn =
        std::max_element(way.begin(), way.end(), [&](auto a, auto b) { return gain(a) < gain(b); });
    if (gain(*turn) < kLeastAcross) return {};
    return Nodes(way.begin(), turn + 1);
  }

  void namePosterior() {
    if (m_marks.basilar == VesselNetwork::kNone) return;
    NodeSet closed = courses();
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n)
      if (!m_name[n].empty()) closed[n] = true;
    const Ways ways = m_network.waysFrom(m_marks.basilar, closed);
    std::array<Nodes, 2> course;  // from the basilar artery to the farthest end of each side
    for (std::size_t h = 0; h < 2; ++h) {
      std::uint32_t tip = VesselNetwork::kNone;
      for (const std::uint32_t n : m_network.ends())
        if (ways.reach(n) && n != m_marks.basilar && aside(n, m_marks.half[h]) > 3 &&
            y(n) > y(m_marks.basilar) - 8 && z(n) > z(m_marks.basilar) + 10)
          if (tip == VesselNetwork::kNone || ways.cost[n] > ways.cost[tip]) tip = n;
      if (tip != VesselNetwork::kNone) course[h] = ways.to(tip);
    }
    for (std::size_t h = 0; h < 2; ++h)
      if (course[h].empty() && m_marks.half[h].isFound()) nameFetal(m_marks.half[h], closed);
    const bool isFork = !course[0].empty() && !course[1].empty();
    if (course[0].empty() && course[1].empty()) return nameBasilarAlone(ways);
    const Nodes& one = course[0].empty() ? course[1] : course[0];
    std::size_t stem = isFork ? commonStart(course[0], course[1]) : turnOf(one);
    const Nodes basilar(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(stem));
    if (basilar.empty()) return;
    const double plausible = basilarPlausible(basilar);
    const double gap = isFork ? 0 : kForkGap;
    for (const std::uint32_t n : basilar)
      if ((at(n) - at(basilar.back())).norm() >= gap) set({n}, "BA", plausible);
    for (std::size_t h = 0; h < 2; ++h)
      if (course[h].size() > stem)
        namePca(m_marks.half[h], course[h], stem, plausible, gap, closed);
  }

  /// A basilar artery without posterior cerebral arteries, up to its farthest end.
  void nameBasilarAlone(const Ways& ways) {
    std::uint32_t tip = m_marks.basilar;
    for (const std::uint32_t n : m_network.ends())
      if (ways.reach(n) && ways.cost[n] > ways.cost[tip]) tip = n;
    if (tip != m_marks.basilar) set(ways.to(tip), "BA", basilarPlausible(ways.to(tip)));
  }

  /// A posterior cerebral artery that the carotid artery feeds, as the basilar artery does not: the
  /// communicating artery goes backwards and towards the midline, up to where it turns aside.
  void nameFetal(const HalfCircle& half, const NodeSet& closed) {
    const NodeSet isCourse = m_network.setOf(half.course);
    Nodes best;  // from the carotid artery to the farthest end behind
    double longest = 0;
    for (std::size_t k = 1; k <= half.terminus; ++k)
      for (const std::uint32_t first : m_network.neighbours(half.course[k])) {
        if (isCourse[first] || closed[first]) continue;
        const Ways ways = m_network.waysFrom(first, closed);
        for (const std::uint32_t n : m_network.ends())
          if (ways.reach(n) && ways.cost[n] > longest && aside(n, half) > kFetalAside &&
              y(n) > y(half.course[k]) + kFetalBehind) {
            longest = ways.cost[n];
            best = ways.to(n);
          }
      }
    if (best.empty()) return;
    const auto turn = std::min_element(
        best.begin(), best.end(), [&](auto a, auto b) { return aside(a, half) < aside(b, half); });
    const Nodes pcom(best.begin(), turn), pca(turn, best.end());
    if (pcom.size() < 2) return;
    const double plausible =
        m_marks.plausible * half.plausible * kPcomLength(m_network.lengthOf(pcom)) *
        kPcomRadius(m_network.medianRadius(pcom)) * kPcaAside(aside(best.back(), half));
    set(pcom, half.name("Pcom"), plausible);
    NodeSet before = closed;
    for (const std::uint32_t n : pcom) before[n] = true;
    setFree(m_network.waysFrom(pca.front(), before).reached(), half.name("PCA"), plausible);
  }

  static std::size_t commonStart(const Nodes& a, const Nodes& b) {
    const auto [end, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
    return static_cast<std::size_t>(end - a.begin());
  }
  /// Where a course that rises turns aside; counted behind it.
  [[nodiscard]] std::size_t turnOf(const Nodes& course) const {
    const auto rise = [&](std::uint32_t n) { return z(n) - std::abs(x(n) - x(course.front())); };
    const auto turn = std::max_element(course.begin(), course.end(),
                                       [&](auto a, auto b) { return rise(a) < rise(b); });
    return static_cast<std::size_t>(turn - course.begin()) + 1;
  }

  [[nodiscard]] double basilarPlausible(const Nodes& basilar) const {
    double depth = 0, level = 0, plausible = 0;
    int count = 0;
    for (const HalfCircle& half : m_marks.half) {
      if (!half.isFound()) continue;
      depth += y(half.end());
      level += z(half.end());
      plausible = std::max(plausible, half.plausible);
      ++count;
    }
    const std::uint32_t top = basilar.back();
    return m_marks.plausible * plausible * kBasilarAside(std::abs(x(top) - m_marks.middle)) *
           kBasilarBehind(y(top) - depth / count) *
           kBasilarUneven(std::abs(z(top) - level / count)) *
           kBasilarLength(m_network.lengthOf(basilar)) *
           kBasilarRadius(m_network.medianRadius(basilar));
  }

  /// A posterior cerebral artery with its branches, and the communicating artery that leads to it.
  void namePca(const HalfCircle& half, const Nodes& course, std::size_t stem, double basilar,
               double gap, NodeSet closed) {
    double farthest = 0;
    for (const std::uint32_t n : course) farthest = std::max(farthest, aside(n, half));
    const double plausible = basilar * kPcaAside(farthest);
    for (std::size_t k = 0; k < stem; ++k) closed[course[k]] = true;
    if (half.isFound()) {
      const Nodes pcom = communicating(half, course, stem, closed);
      set(pcom, half.name("Pcom"),
          plausible * kPcomLength(m_network.lengthOf(pcom)) *
              kPcomRadius(m_network.medianRadius(pcom)));
      for (const std::uint32_t n : pcom) closed[n] = true;
    }
    // without an end of its carotid artery, a branch may be the communicating artery
    const Nodes all = half.isFound()
                          ? m_network.waysFrom(course[stem], closed).reached()
                          : Nodes(course.begin() + static_cast<std::ptrdiff_t>(stem), course.end());
    for (const std::uint32_t n : all)
      if ((m_network.position(n) - m_network.position(course[stem - 1])).norm() >= gap)
        setFree({n}, half.name("PCA"), plausible);
  }

  /// The nodes between a carotid artery and the course of the posterior cerebral artery of its side.
  [[nodiscard]] Nodes communicating(const HalfCircle& half, const Nodes& course, std::size_t stem,
                                    NodeSet closed) const {
    for (std::size_t k = 0; k <= half.terminus; ++k) closed[half.course[k]] = false;
    const Ways ways = m_network.waysFrom(half.end(), closed);
    std::uint32_t meeting = VesselNetwork::kNone;
    for (std::size_t k = stem; k < course.size(); ++k)
      if (ways.reach(course[k]) &&
          (meeting == VesselNetwork::kNone || ways.cost[course[k]] < ways.cost[meeting]))
        meeting = course[k];
    if (meeting == VesselNetwork::kNone) return {};
    const NodeSet isCourse = m_network.setOf(course), isCarotid = m_network.setOf(half.course);
    Nodes between;
    for (const std::uint32_t n : ways.to(meeting))
      if (!isCourse[n] && !isCarotid[n]) between.push_back(n);
    return between;
  }

  const formats::CenterlineTree& m_tree;
  std::vector<std::string> m_name;  // of each node
  std::vector<double> m_plausible;
};

}  // namespace

std::vector<ArteryStretch> nameCircleOfWillis(const formats::CenterlineTree& tree) {
  const VesselNetwork network(tree);
  return CircleNames(tree, network).find();
}

}  // namespace lumen::convert
