// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/find_inlets.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/inlets.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

/// Least ratio of the radii of both arms of a fork and of an inlet to that of the vessel between: by
/// Murray's law an arm of a fork is no wider than what feeds it, and half of the flow takes 1.26
/// times the radius.
constexpr double kWider = 1.26;
constexpr std::size_t kWidthNodes = 8;  // of an arm, or of an end, that show its radius
constexpr double kBeyondRadii = 2;      // from an end on, outside of the volume

class Flow {
public:
  Flow(const CenterlineTree& tree, const std::function<bool(const Vector3d&)>& isInside)
      : m_tree(tree), m_isInside(isInside), m_children(tree.nodeCount()) {
    for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
      if (tree.parent[i] != formats::kNoParent && isVessel(i))
        m_children[static_cast<std::size_t>(tree.parent[i])].push_back(i);
  }

  std::vector<Vector3d> inlets() {
    std::vector<Vector3d> out;
    std::vector<bool> isTaken(m_tree.nodeCount(), false);
    const std::vector<std::uint32_t> order = rootsFirst();
    for (auto node = order.rbegin(); node != order.rend(); ++node) {
      if (m_children[*node].size() < 2 || !isFedByNarrower(*node, isTaken)) continue;
      const auto end = widestEnd(*node, isTaken);
      if (!end) continue;
      const Vector3d root = centre(rootAbove(m_tree, *node));
      if (std::find(out.begin(), out.end(), root) == out.end()) out.push_back(root);
      out.push_back(centre(*end));
      take(*node, isTaken);
    }
    return out;
  }

private:
  [[nodiscard]] bool isVessel(std::uint32_t i) const {
    return m_tree.branches[m_tree.branch[i]].kind == formats::BranchKind::Vessel;
  }
  [[nodiscard]] Vector3d centre(std::uint32_t i) const { return toEigen(m_tree.centre[i]); }
  [[nodiscard]] double radius(std::uint32_t i) const { return double{m_tree.radius[i]}; }

  [[nodiscard]] std::vector<std::uint32_t> rootsFirst() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < m_tree.nodeCount(); ++i)
      if (m_tree.parent[i] == formats::kNoParent && isVessel(i)) order.push_back(i);
    for (std::size_t k = 0; k < order.size(); ++k)
      order.insert(order.end(), m_children[order[k]].begin(), m_children[order[k]].end());
    return order;
  }

  [[nodiscard]] double medianRadius(std::span<const std::uint32_t> nodes) const {
    std::vector<double> radii;
    for (const std::uint32_t i : nodes) radii.push_back(radius(i));
    return radii.empty() ? 0 : upperMedian(radii);
  }

  /// The nodes of an arm of a fork behind the fork's lumen, as far as the next fork.
  [[nodiscard]] std::vector<std::uint32_t> arm(std::uint32_t fork, std::uint32_t first) const {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = first; nodes.size() < kWidthNodes; i = m_children[i][0]) {
      if ((centre(i) - centre(fork)).norm() > radius(fork)) nodes.push_back(i);
      if (m_children[i].size() != 1) break;
    }
    return nodes;
  }

  /// The nodes between a fork and the one before it, outside of the lumen of both; empty behind a
  /// root.
  [[nodiscard]] std::vector<std::uint32_t> feeding(std::uint32_t fork) const {
    std::vector<std::uint32_t> nodes;
    std::int32_t i = m_tree.parent[fork];
    while (i != formats::kNoParent && m_children[static_cast<std::size_t>(i)].size() < 2) {
      nodes.push_back(static_cast<std::uint32_t>(i));
      i = m_tree.parent[static_cast<std::size_t>(i)];
    }
    if (i == formats::kNoParent) return {};
    const auto before = static_cast<std::uint32_t>(i);
    std::erase_if(nodes, [&](std::uint32_t n) {
      return (centre(n) - centre(fork)).norm() < radius(fork) ||
             (centre(n) - centre(before)).norm() < radius(before);
    });
    return nodes;
  }

  [[nodiscard]] bool isFedByNarrower(std::uint32_t fork, const std::vector<bool>& isTaken) const {
    const std::vector<std::uint32_t> before = feeding(fork);
    if (before.empty() || isTaken[fork]) return false;
    m_feeding = medianRadius(before);
    return std::all_of(m_children[fork].begin(), m_children[fork].end(), [&](std::uint32_t child) {
      return medianRadius(arm(fork, child)) > kWider * m_feeding;
    });
  }

  /// The widest end of the volume behind a fork, wider than what feeds the fork.
  [[nodiscard]] std::optional<std::uint32_t> widestEnd(std::uint32_t fork,
                                                       const std::vector<bool>& isTaken) const {
    std::optional<std::uint32_t> best;
    double widest = kWider * m_feeding;
    std::vector<std::uint32_t> below(1, fork);
    for (std::size_t k = 0; k < below.size(); ++k) {
      const std::uint32_t i = below[k];
      if (isTaken[i]) continue;
      below.insert(below.end(), m_children[i].begin(), m_children[i].end());
      if (!m_children[i].empty() || !leavesVolume(i)) continue;
      const double width = medianRadius(end(i));
      if (width > widest) {
        widest = width;
        best = i;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<std::uint32_t> end(std::uint32_t tip) const {
    std::vector<std::uint32_t> nodes;
    for (auto i = static_cast<std::int32_t>(tip);
         i != formats::kNoParent && nodes.size() < kWidthNodes;
         i = m_tree.parent[static_cast<std::size_t>(i)])
      nodes.push_back(static_cast<std::uint32_t>(i));
    return nodes;
  }

  [[nodiscard]] bool leavesVolume(std::uint32_t tip) const {
    const std::int32_t before = m_tree.parent[tip];
    if (before == formats::kNoParent) return false;
    const Vector3d ahead = centre(tip) - centre(static_cast<std::uint32_t>(before));
    if (!(ahead.norm() > 0)) return false;
    return !m_isInside(centre(tip) + kBeyondRadii * radius(tip) * ahead.normalized());
  }

  void take(std::uint32_t fork, std::vector<bool>& isTaken) const {
    std::vector<std::uint32_t> below(1, fork);
    for (std::size_t k = 0; k < below.size(); ++k) {
      isTaken[below[k]] = true;
      below.insert(below.end(), m_children[below[k]].begin(), m_children[below[k]].end());
    }
  }

  const CenterlineTree& m_tree;
  const std::function<bool(const Vector3d&)>& m_isInside;
  std::vector<std::vector<std::uint32_t>> m_children;
  mutable double m_feeding = 0;
};

}  // namespace

std::vector<Vector3d> furtherInlets(const CenterlineTree& tree,
                                    const std::function<bool(const Vector3d&)>& isInside) {
  return Flow(tree, isInside).inlets();
}

}  // namespace lumen::convert
