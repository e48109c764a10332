// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/aortic_arch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/anatomy/arch_landmarks.h"
#include "converters/stages/anatomy/usual.h"
#include "converters/stages/anatomy/vessel_network.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Nodes = std::vector<std::uint32_t>;
using Ways = VesselNetwork::Ways;

// Wide ranges about those of adults, in radii of the arch (S. Standring, Gray's Anatomy: the order and
// the courses of the branches, the trunk as the widest and 4 to 5 cm long, a common carotid artery
// without branches before it divides).
constexpr Usual kTrunkRadius{0.25, 0.75, 0.05}, kCarotidRadius{0.12, 0.5, 0.03},
    kSubclavianRadius{0.15, 0.6, 0.04};
constexpr Usual kAscendingLength{1, 9, 1.5};  // from end to end
constexpr Usual kTrunkLength{1, 5.5, 0.5};    // from end to end; 4 to 5 cm are outside of the aorta
constexpr Usual kAlike{0.7, 1.4, 0.1};  // radius of the right carotid artery over that of the left
constexpr Usual kInOrder{0, 20, 0.3};   // how far left of the vessel before it one rises
constexpr Usual kLeftOfOrigin{0.3, 8, 0.2};  // of a left carotid artery that the trunk gives
constexpr Usual kSteeper{0.3, 3, 0.15};      // of a carotid artery beside a subclavian one
constexpr double kThin = 0.75;    // a vertebral artery, of the thinner of both vessels beside it
constexpr double kUnclear = 0.8;  // of the aorta where great vessels are too few or too many
constexpr double kLeastBranch = 1.5;  // length of what makes a fork
// Lengths up to which vessels have their name where no fork ends it before.
constexpr double kSureTrunk = 4, kSubclavian = 6, kCommonCarotid = 8;
constexpr double kPast = 3;          // where directions are taken
constexpr double kDescent = 2;       // below the apex the aorta descends
constexpr double kAorticFork = 0.6;  // radius of one iliac artery over that of the other

class ArchNames {
public:
  ArchNames(const formats::CenterlineTree& tree, const VesselNetwork& network)
      : m_tree(tree),
        m_network(network),
        m_arch(findArch(network, tree.nodeCount())),
        m_isClosed(network.setOf(m_arch.course)),
        m_name(tree.nodeCount()),
        m_plausible(tree.nodeCount(), 0) {}

  std::vector<ArteryStretch> find() {
    if (m_arch.vessels.size() < 2) return {};
    const bool isClear = nameVessels();
    nameAorta(isClear);
    return stretchesOf(m_tree, m_name, m_plausible);
  }

private:
  /// A vessel up to where it divides.
  struct Stem {
    Nodes nodes;
    Nodes next;  ///< first nodes behind it; none at an end
  };

  [[nodiscard]] Vector3d at(std::uint32_t n) const { return m_network.position(n); }
  [[nodiscard]] double unit() const { return m_arch.radius; }

  void set(const Nodes& nodes, const char* name, double plausible) {
    for (const std::uint32_t n : nodes) {
      m_name[n] = name;
      m_plausible[n] = plausible;
    }
  }

  /// From a first node to where at least two long vessels go on.
  [[nodiscard]] Stem stemFrom(std::uint32_t first) const {
    Stem stem;
    NodeSet isClosed = m_isClosed;
    for (std::uint32_t n = first;;) {
      stem.nodes.push_back(n);
      isClosed[n] = true;
      double longest = -1;
      std::uint32_t on = n;
      stem.next.clear();
      for (const std::uint32_t m : m_network.neighbours(n)) {
        if (isClosed[m]) continue;
        const double length = m_network.neighbours(n).size() > 2 ? reachOf(m, isClosed) : 0;
        if (length > kLeastBranch * unit()) stem.next.push_back(m);
        if (length > longest) {
          longest = length;
          on = m;
        }
      }
      if (stem.next.size() > 1) return stem;
      stem.next.clear();
      if (on == n) return stem;
      n = on;
    }
  }

  [[nodiscard]] double reachOf(std::uint32_t n, const NodeSet& closed) const {
    const Ways ways = m_network.waysFrom(n, closed, VesselNetwork::WayCost::Length, kPast * unit());
    double longest = 0;
    for (const std::uint32_t m : ways.reached()) longest = std::max(longest, ways.cost[m]);
    return longest;
  }

  /// Where a vessel behind a stem has come to after kPast, on its way to its farthest end.
  [[nodiscard]] Vector3d pastFork(const Stem& stem, std::uint32_t first) const {
    const Ways ways = waysBehind(stem, first, kPast);
    std::uint32_t far = first;
    for (const std::uint32_t n : ways.reached())
      if (ways.cost[n] > ways.cost[far]) far = n;
    return at(far) - at(stem.nodes.back());
  }

  [[nodiscard]] Ways waysBehind(const Stem& stem, std::uint32_t first, double most) const {
    NodeSet isClosed = m_isClosed;
    for (const std::uint32_t n : stem.nodes) isClosed[n] = true;
    return m_network.waysFrom(first, isClosed, VesselNetwork::WayCost::Length, most * unit());
  }

  /// A carotid artery, which gives no branch before it divides.
  [[nodiscard]] Nodes carotid(std::uint32_t first) const {
    Nodes nodes = stemFrom(first).nodes;
    double run = 0;
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      run += m_network.length(nodes[k - 1], nodes[k]);
      if (run > kCommonCarotid * unit()) nodes.resize(k);
    }
    return nodes;
  }

  /// The way to the end that is farthest aside, as far as it is surely a subclavian artery.
  [[nodiscard]] Nodes subclavian(const Stem& before, std::uint32_t first, double side) const {
    const Ways ways = waysBehind(before, first, kSubclavian);
    std::uint32_t tip = first;
    for (const std::uint32_t n : ways.reached())
      if (side * at(n).x() > side * at(tip).x()) tip = n;
    return ways.to(tip);
  }

  /// The vessel behind a trunk that goes to the left of where the trunk begins, and how plausibly.
  [[nodiscard]] std::pair<std::uint32_t, double> leftOf(const Stem& trunk, double origin) const {
    std::pair<std::uint32_t, double> best{VesselNetwork::kNone, 0};
    for (const std::uint32_t n : trunk.next) {
      const double left = at(trunk.nodes.back()).x() + pastFork(trunk, n).x() - origin;
      const double plausible = kLeftOfOrigin(left / unit());
      if (plausible > best.second) best = {n, plausible};
    }
    return best;
  }

  /// The great vessels; false where they are too few or too many.
  bool nameVessels() {
    const std::vector<GreatVessel>& all = m_arch.vessels;
    const GreatVessel &first = all.front(), &last = all.back();
    Stem trunk = stemFrom(first.first);
    const auto inOrder = [&](const GreatVessel& a, const GreatVessel& b) {
      return kInOrder((b.left - a.left) / unit());
    };
    // without the vertebral artery, which may leave the arch between the left carotid and the left
    // subclavian artery
    std::vector<GreatVessel> main = all;
    for (std::size_t i = 1; i + 1 < main.size(); ++i)
      if (main[i].radius < kThin * std::min(main[i - 1].radius, main[i + 1].radius) &&
          (main.size() == 4 ||
           leftOf(trunk, at(m_arch.course[first.place]).x()).second >= kLeastPlausibility)) {
        main.erase(main.begin() + static_cast<std::ptrdiff_t>(i));
        break;
      }
    if (main.size() == 3) {
      const double plausible = m_arch.plausible * inOrder(first, main[1]) * inOrder(main[1], last) *
                               kTrunkRadius(first.radius / unit());
      nameTrunk(trunk, main[1].radius, plausible);
      set(carotid(main[1].first), "common_carotid_artery_left",
          plausible * kCarotidRadius(main[1].radius / unit()));
      nameLeftSubclavian(last, plausible);
      return true;
    }
    const auto [left, isLeft] = leftOf(trunk, at(m_arch.course[first.place]).x());
    if (main.size() != 2 || isLeft < kLeastPlausibility) return false;
    const double plausible =
        m_arch.plausible * isLeft * inOrder(first, last) * kTrunkRadius(first.radius / unit());
    nameBovine(trunk, left, plausible);
    nameLeftSubclavian(last, plausible);
    return true;
  }

  void nameLeftSubclavian(const GreatVessel& vessel, double plausible) {
    set(subclavian({{m_arch.course[vessel.place]}, {}}, vessel.first, 1), "subclavian_artery_left",
        plausible * kSubclavianRadius(vessel.radius / unit()));
  }

  /// A trunk that gives the left carotid artery also.
  void nameBovine(Stem trunk, std::uint32_t left, double plausible) {
    for (const std::uint32_t n : trunk.nodes) m_isClosed[n] = true;
    const Nodes up = carotid(left);
    set(up, "common_carotid_artery_left",
        plausible * kCarotidRadius(m_network.medianRadius(up) / unit()));
    std::erase(trunk.next, left);
    if (trunk.next.size() == 1) {
      const Stem rest = stemFrom(trunk.next.front());
      trunk.nodes.insert(trunk.nodes.end(), rest.nodes.begin(), rest.nodes.end());
      trunk.next = rest.next;
    }
    nameTrunk(trunk, m_network.medianRadius(up), plausible);
  }

  /// A trunk and the two right vessels behind it: the carotid artery is the steeper one. A trunk that
  /// is too long has lost one of them, and is named as far as it is surely one.
  void nameTrunk(const Stem& trunk, double leftCarotid, double plausible) {
    const auto away = [&](std::uint32_t n) {
      return (at(n) - at(trunk.nodes.front())).norm() / unit();
    };
    const double fit = kTrunkLength(away(trunk.nodes.back()));
    for (const std::uint32_t n : trunk.nodes)
      if (fit > kLeastPlausibility || away(n) < kSureTrunk)
        set({n}, "brachiocephalic_trunk", plausible);
    if (trunk.next.size() != 2) return;
    std::uint32_t steeper = trunk.next[0], other = trunk.next[1];
    const auto steep = [&](std::uint32_t n) {
      const Vector3d way = pastFork(trunk, n).normalized();
      return way.z() + way.x();
    };
    if (steep(other) > steep(steeper)) std::swap(steeper, other);
    const double both = plausible * fit * kSteeper(steep(steeper) - steep(other));
    for (const std::uint32_t n : trunk.nodes) m_isClosed[n] = true;
    const Nodes up = carotid(steeper), aside = subclavian(trunk, other, -1);
    set(up, "common_carotid_artery_right",
        both * kCarotidRadius(m_network.medianRadius(up) / unit()) *
            kAlike(m_network.medianRadius(up) / leftCarotid));
    set(aside, "subclavian_artery_right",
        both * kSubclavianRadius(m_network.medianRadius(aside) / unit()));
  }

  /// The place of the course at a length from another one, behind it or, if negative, before it.
  [[nodiscard]] std::size_t placeAt(std::size_t k, double length) const {
    for (double run = 0; run < std::abs(length);) {
      const bool isEnd = length > 0 ? k + 1 == m_arch.course.size() : k == 0;
      if (isEnd) break;
      const std::size_t next = length > 0 ? k + 1 : k - 1;
      run += m_network.length(m_arch.course[k], m_arch.course[next]);
      k = next;
    }
    return k;
  }

  [[nodiscard]] Nodes part(std::size_t from, std::size_t to) const {
    return Nodes(m_arch.course.begin() + static_cast<std::ptrdiff_t>(from),
                 m_arch.course.begin() + static_cast<std::ptrdiff_t>(to));
  }

  /// The arch reaches from the first to the last of its vessels. Where these are not clear, a part
  /// behind the last that is seen has no name.
  void nameAorta(bool isClear) {
    const double plausible = m_arch.plausible * (isClear ? 1 : kUnclear);
    const GreatVessel &first = m_arch.vessels.front(), &last = m_arch.vessels.back();
    const std::size_t begin = placeAt(first.place, -first.radius),
                      end = placeAt(last.place, last.radius);
    const Nodes ascending = part(0, begin);
    set(ascending, "ascending_aorta",
        plausible *
            kAscendingLength(ascending.empty()
                                 ? 0
                                 : (at(ascending.back()) - at(ascending.front())).norm() / unit()));
    set(part(begin, end + 1), "aortic_arch", plausible);
    std::size_t down = end + 1;
    const double low = at(m_arch.course[m_arch.apex]).z() - kDescent * unit();
    while (!isClear && down < m_arch.end && at(m_arch.course[down]).z() > low) ++down;
    const std::size_t fork = aorticFork(std::min(down, m_arch.course.size()));
    if (fork > down) set(part(down, fork), "descending_aorta", plausible);
  }

  /// Where the aorta divides into its iliac arteries, or its course ends.
  [[nodiscard]] std::size_t aorticFork(std::size_t from) const {
    for (std::size_t k = from; k < m_arch.course.size(); ++k)
      for (const std::uint32_t n : m_network.neighbours(m_arch.course[k])) {
        if (m_isClosed[n]) continue;
        const std::size_t beyond = placeAt(k, kPast * unit());
        const double own = m_network.medianRadius(part(k, beyond + 1));
        if (reachOf(n, m_isClosed) > kDescent * unit() &&
            m_network.medianRadius(stemFrom(n).nodes) > kAorticFork * own)
          return k;
      }
    return m_arch.course.size();
  }

  const formats::CenterlineTree& m_tree;
  const VesselNetwork& m_network;
  ArchLandmarks m_arch;
  NodeSet m_isClosed;
  std::vector<std::string> m_name;  // of each node
  std::vector<double> m_plausible;
};

}  // namespace

std::vector<ArteryStretch> nameAorticArch(const formats::CenterlineTree& tree) {
  const VesselNetwork network(tree);
  return ArchNames(tree, network).find();
}

}  // namespace lumen::convert
