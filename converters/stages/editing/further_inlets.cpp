// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/further_inlets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/trim.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr double kBeyondRadii = 2;  // from an end on, outside of the volume

bool isVesselNode(const CenterlineTree& tree, std::uint32_t i) {
  return tree.branches[tree.branch[i]].kind == formats::BranchKind::Vessel;
}

/// The vessels that go on at each node.
std::vector<std::vector<std::uint32_t>> findArms(const CenterlineTree& tree) {
  std::vector<std::vector<std::uint32_t>> arms(tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] != formats::kNoParent && isVesselNode(tree, i))
      arms[static_cast<std::size_t>(tree.parent[i])].push_back(i);
  return arms;
}

/// The median radius of a stretch between two forks, from one to the other, outside of the lumen of
/// both; empty if nothing of it lies there.
std::optional<double> widthBetween(const CenterlineTree& tree,
                                   const std::vector<std::uint32_t>& stretch) {
  std::vector<double> radii;
  for (std::size_t k = 1; k + 1 < stretch.size(); ++k) {
    const auto isIn = [&, at = toEigen(tree.centre[stretch[k]])](std::uint32_t fork) {
      return (at - toEigen(tree.centre[fork])).norm() < double{tree.radius[fork]};
    };
    if (!isIn(stretch.front()) && !isIn(stretch.back()))
      radii.push_back(double{tree.radius[stretch[k]]});
  }
  if (radii.empty()) return std::nullopt;
  return upperMedian(radii);
}

class InletSearch {
public:
  explicit InletSearch(const CenterlineTree& tree) : m_tree(tree), m_arms(findArms(tree)) {}

  /// The widest end that leaves the volume and that its tree does not feed, but for `refused`.
  [[nodiscard]] std::optional<FurtherInlet> widest(
      const std::function<bool(const Vector3d&)>& isInside,
      const std::set<std::array<float, 3>>& refused) const {
    std::optional<FurtherInlet> best;
    for (std::uint32_t i = 0; i < m_tree.nodeCount(); ++i) {
      const formats::Vec3f& c = m_tree.centre[i];
      if (!m_arms[i].empty() || !isVesselNode(m_tree, i) || refused.contains({c.x, c.y, c.z}) ||
          !leavesVolume(i, isInside))
        continue;
      const double radius = calibreOfTip(i);
      if (best && radius <= best->radius) continue;
      if (const auto narrowest = narrowestBefore(i, radius))
        best = FurtherInlet{toEigen(c), radius, *narrowest};
    }
    return best;
  }

private:
  /// The radius, mm, of the narrowest vessel on the way to a tip that can feed neither its end, of
  /// `width`, nor another vessel that leaves the way behind it.
  [[nodiscard]] std::optional<double> narrowestBefore(std::uint32_t tip, double width) const {
    std::optional<double> least;
    double widestArm = 0;                // of those that leave the way behind
    std::vector<std::uint32_t> stretch;  // from the last fork on
    std::uint32_t behind = tip;
    for (std::int32_t i = m_tree.parent[tip]; i != formats::kNoParent;
         i = m_tree.parent[static_cast<std::size_t>(i)]) {
      const auto at = static_cast<std::uint32_t>(i);
      const bool isFork = m_arms[at].size() > 1;
      if (isFork || !stretch.empty()) stretch.push_back(at);
      if (isFork) {
        const auto narrow = widthBetween(m_tree, stretch);
        if (narrow && std::min(width, widestArm) > kHalfFlowRadii * *narrow &&
            (!least || *narrow < *least))
          least = narrow;
        stretch.assign(1, at);
        for (const std::uint32_t arm : m_arms[at])
          if (arm != behind) widestArm = std::max(widestArm, calibreOfArm(at, arm));
      }
      behind = at;
    }
    return least;
  }

  /// calibre() of a vessel that leaves a fork, along its widest course.
  [[nodiscard]] double calibreOfArm(std::uint32_t fork, std::uint32_t first) const {
    std::vector<double> radii, steps;
    const Vector3d begin = toEigen(m_tree.centre[fork]);
    for (std::uint32_t i = first;; i = widestOf(m_arms[i])) {
      if ((toEigen(m_tree.centre[i]) - begin).norm() > double{m_tree.radius[fork]}) {
        if (!radii.empty()) steps.push_back(formats::edgeLength(m_tree, i));
        radii.push_back(double{m_tree.radius[i]});
      }
      if (m_arms[i].empty()) break;
    }
    return radii.empty() ? 0 : calibre(radii, steps);
  }

  [[nodiscard]] std::uint32_t widestOf(const std::vector<std::uint32_t>& nodes) const {
    return *std::max_element(nodes.begin(), nodes.end(), [&](std::uint32_t a, std::uint32_t b) {
      return m_tree.radius[a] < m_tree.radius[b];
    });
  }

  [[nodiscard]] double calibreOfTip(std::uint32_t tip) const {
    std::vector<double> radii{double{m_tree.radius[tip]}}, steps;
    for (std::uint32_t i = tip; m_tree.parent[i] != formats::kNoParent;) {
      const auto before = static_cast<std::uint32_t>(m_tree.parent[i]);
      if (m_arms[before].size() > 1) break;
      steps.push_back(formats::edgeLength(m_tree, i));
      radii.push_back(double{m_tree.radius[before]});
      i = before;
    }
    return calibre(radii, steps);
  }

  [[nodiscard]] bool leavesVolume(std::uint32_t tip,
                                  const std::function<bool(const Vector3d&)>& isInside) const {
    const std::int32_t before = m_tree.parent[tip];
    if (before == formats::kNoParent) return false;
    const Vector3d at = toEigen(m_tree.centre[tip]);
    const Vector3d ahead = at - toEigen(m_tree.centre[static_cast<std::size_t>(before)]);
    if (!(ahead.norm() > 0)) return false;
    return !isInside(at + kBeyondRadii * double{m_tree.radius[tip]} * ahead.normalized());
  }

  const CenterlineTree& m_tree;
  std::vector<std::vector<std::uint32_t>> m_arms;
};

}  // namespace

std::vector<FurtherInlet> beginAtFurtherInlets(
    formats::Case& target, const std::function<bool(const Vector3d&)>& isInside) {
  std::vector<FurtherInlet> made;
  std::set<std::array<float, 3>> refused;  // centres, as indices change
  while (const auto inlet = InletSearch(target.tree).widest(isInside, refused)) {
    const auto place = placeIn(target.tree, inlet->centre);
    if (!place) break;
    const std::size_t links = target.tree.links.size();
    const std::array<Vector3d, 2> places{
        toEigen(target.tree.centre[rootAbove(target.tree, place->node)]), inlet->centre};
    beginAt(target, places);
    const formats::Vec3f centre = toVec3f(inlet->centre);
    refused.insert({centre.x, centre.y, centre.z});
    if (target.tree.links.size() > links) made.push_back(*inlet);
  }
  return made;
}

void reportInlets(const std::vector<FurtherInlet>& inlets, Progress& progress) {
  for (const FurtherInlet& inlet : inlets)
    progress.detail("blood comes in at " + vectorText(inlet.centre) + " mm, too: its radius of " +
                    fixedText(inlet.radius, 2) + " mm is too wide for a vessel behind one of " +
                    fixedText(inlet.narrowest, 2) + " mm");
}

}  // namespace lumen::convert
