// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_of_willis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

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
constexpr double kTrunk = 10;  // length of an A2, of which it rises or advances kTrunkRise
constexpr double kTrunkRise = 8, kTrunkApart = 20;
constexpr double kForkGap = 4;  // around the end of a basilar artery without a fork

class CircleNames {
public:
  explicit CircleNames(const formats::CenterlineTree& tree)
      : m_tree(tree),
        m_network(tree),
        m_marks(findCircleLandmarks(m_network, tree.branches)),
        m_name(tree.nodeCount()),
        m_plausible(tree.nodeCount(), 0) {}

  std::vector<ArteryStretch> find() {
    if (!(m_marks.plausible > 0)) return {};
    for (const HalfCircle& half : m_marks.half)
      if (half.isFound()) nameCarotid(half);
    nameAnterior();
    namePosterior();
    return stretches();
  }

private:
  [[nodiscard]] Vector3d at(std::uint32_t n) const { return m_network.position(n); }
  [[nodiscard]] double x(std::uint32_t n) const { return at(n).x(); }
  [[nodiscard]] double y(std::uint32_t n) const { return at(n).y(); }
  [[nodiscard]] double z(std::uint32_t n) const { return at(n).z(); }
  [[nodiscard]] double aside(std::uint32_t n, const HalfCircle& half) const {
    return half.sign * (x(n) - m_marks.middle);
  }
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
        beyond.reach(half.a1.front()) || beyond.reach(m_marks.half[0].inlet) ||
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
      if (!half.isFound()) continue;
      const Nodes all = m_network.waysFrom(half.a1.front(), closed).reached();
      const bool crosses = std::any_of(all.begin(), all.end(), [&](std::uint32_t n) {
        return aside(n, half) < -4 || n == m_marks.basilar;
      });
      // beyond the midline it may feed both sides
      set(m_marks.isPair() && !crosses ? all : half.a1, half.name("ACA"),
          m_marks.plausible * half.plausible);
    }
  }

  /// An A2 that leaves the way between both carotid arteries.
  struct Trunk {
    std::size_t place = 0;  ///< on the way
    Nodes nodes;
    bool isOne = false;  ///< and not two side by side
  };

  [[nodiscard]] std::vector<Trunk> trunksOn(const Nodes& way, NodeSet closed) const {
    for (const std::uint32_t n : way) closed[n] = true;
    std::vector<Trunk> trunks;
    for (std::size_t k = 0; k < way.size(); ++k)
      for (const std::uint32_t first : m_network.neighbours(way[k])) {
        if (closed[first]) continue;
        const Ways ways = m_network.waysFrom(first, closed);
        Trunk trunk{k, ways.reached(), true};
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
    set(part(0, low + 1), right.name("ACA"), plausible);
    set(part(high, way.size()), left.name("ACA"), plausible);
    if (high == low || trunks.size() != 2 || !trunks.front().isOne || !trunks.back().isOne) return;
    if (high > low + 1)
      set(part(low + 1, high), "Acom",
          plausible * kAcomLength(m_network.lengthOf(part(low, high + 1))) *
              kAcomAside(std::abs(x(way[low]) - m_marks.middle)) *
              kAcomAside(std::abs(x(way[high]) - m_marks.middle)));
    set(trunks.front().nodes, right.name("ACA"), plausible);
    set(trunks.back().nodes, left.name("ACA"), plausible);
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
    const bool isFork = !course[0].empty() && !course[1].empty();
    if (course[0].empty() && course[1].empty()) return;
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

  /// The name of a node, where it is plausible enough.
  [[nodiscard]] std::string plausibleName(std::uint32_t n) const {
    return m_plausible[n] < kLeastPlausibility ? std::string{} : m_name[n];
  }

  /// Neighbours of one name in a branch are a stretch; a single node, as where vessels meet, belongs to
  /// the longer of those beside it.
  [[nodiscard]] std::vector<ArteryStretch> stretches() const {
    std::vector<ArteryStretch> out;
    for (std::uint32_t b = 0; b < m_tree.branches.size(); ++b) {
      const formats::Branch& branch = m_tree.branches[b];
      std::vector<ArteryStretch> runs;
      for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
        if (runs.empty() || runs.back().name != plausibleName(n))
          runs.push_back({b, n, n + 1, plausibleName(n), m_plausible[n]});
        else
          extend(runs.back(), n + 1, m_plausible[n]);
      absorbSingle(runs);
      for (ArteryStretch& run : runs)
        if (!run.name.empty()) out.push_back(std::move(run));
    }
    return out;
  }

  static void extend(ArteryStretch& run, std::uint32_t end, double plausible) {
    run.end = end;
    run.plausibility = std::min(run.plausibility, plausible);
  }
  static void absorbSingle(std::vector<ArteryStretch>& runs) {
    const auto isNode = [](const ArteryStretch& run) { return run.end - run.first == 1; };
    const auto count = [&](std::size_t i) { return runs[i].end - runs[i].first; };
    for (auto run = std::find_if(runs.begin(), runs.end(), isNode);
         run != runs.end() && runs.size() > 1;
         run = std::find_if(runs.begin(), runs.end(), isNode)) {
      const auto k = static_cast<std::size_t>(run - runs.begin());
      const bool isBefore = k + 1 == runs.size() || (k > 0 && count(k - 1) > count(k + 1));
      ArteryStretch& other = runs[isBefore ? k - 1 : k + 1];
      other.first = std::min(other.first, run->first);
      other.end = std::max(other.end, run->end);
      runs.erase(run);
      // those beside it may have one name now
      for (std::size_t i = 1; i < runs.size(); ++i)
        if (runs[i].name == runs[i - 1].name) {
          extend(runs[i - 1], runs[i].end, runs[i].plausibility);
          runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i--));
        }
    }
  }

  const formats::CenterlineTree& m_tree;
  VesselNetwork m_network;
  CircleLandmarks m_marks;
  std::vector<std::string> m_name;  // of each node
  std::vector<double> m_plausible;
};

}  // namespace

std::vector<ArteryStretch> nameCircleOfWillis(const formats::CenterlineTree& tree) {
  return CircleNames(tree).find();
}

}  // namespace lumen::convert
