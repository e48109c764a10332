// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/sac_tree.h"

#include <algorithm>
#include <optional>

#include "converters/base/vectors.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kSecondPlace = 1.5;  // diameters (Dhar et al., 2008)

bool isSac(const formats::CenterlineTree& tree, std::uint32_t node) {
  return tree.branches[tree.branch[node]].kind == formats::BranchKind::Aneurysm;
}

void addBranch(const formats::CenterlineTree& tree, std::uint32_t index, SacTree& sac) {
  const formats::Branch& branch = tree.branches[index];
  sac.branches.push_back(index);
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    sac.nodes.push_back(n);
}

void describe(const formats::CenterlineTree& tree, SacTree& sac) {
  std::sort(sac.nodes.begin(), sac.nodes.end());
  double sum = 0;
  for (const std::uint32_t n : sac.nodes) {
    const double r = static_cast<double>(tree.radius[n]), weight = r * r * r;
    sac.middle += weight * toEigen(tree.centre[n]);
    sum += weight;
    if (r > sac.radius) {
      sac.radius = r;
      sac.widest = n;
    }
  }
  sac.middle /= sum;
}

/// Walks along vessels, away from a sac.
class VesselWalk {
public:
  VesselWalk(const formats::CenterlineTree& tree, std::uint32_t start)
      : m_tree(tree), m_neighbours(tree), m_along(tree.nodeCount(), -1) {
    m_along[start] = 0;
  }

  /// The first nodes farther than `clearance` from the start, in the order of the walk.
  std::vector<std::uint32_t> firstBeyond(std::uint32_t start, double clearance) {
    std::vector<std::uint32_t> found, open{start};
    while (!open.empty()) {
      const std::uint32_t n = open.back();
      open.pop_back();
      eachNext(n, [&](std::uint32_t next) {
        m_along[next] = m_along[n] + length(n, next);
        if (m_along[next] > clearance)
          found.push_back(next);
        else
          open.push_back(next);
      });
    }
    return found;
  }

  /// The last node within `reach` along the vessel that goes on from `node`, up to its next fork.
  std::uint32_t follow(std::uint32_t node, double reach) {
    double left = reach;
    for (;;) {
      std::optional<std::uint32_t> only;
      int count = 0;
      eachNext(node, [&](std::uint32_t next) {
        only = next;
        ++count;
      });
      if (count != 1 || length(node, *only) > left) return node;
      left -= length(node, *only);
      m_along[*only] = m_along[node] + length(node, *only);
      node = *only;
    }
  }

private:
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return (toEigen(m_tree.centre[a]) - toEigen(m_tree.centre[b])).norm();
  }
  template <class Visit>
  void eachNext(std::uint32_t node, Visit visit) const {
    for (const std::uint32_t next : m_neighbours.of(node))
      if (m_along[next] < 0 && !isSac(m_tree, next)) visit(next);
  }

  const formats::CenterlineTree& m_tree;
  formats::Neighbours m_neighbours;
  std::vector<double> m_along;  // mm from the start; negative: not met yet
};

}  // namespace

std::vector<SacTree> findSacs(const formats::CenterlineTree& tree) {
  std::vector<SacTree> sacs;
  std::vector<std::size_t> sacOf(tree.branches.size(), SIZE_MAX);
  // a branch comes after its parent, whose nodes have smaller indices
  std::vector<std::uint32_t> order(tree.branches.size());
  for (std::uint32_t b = 0; b < order.size(); ++b) order[b] = b;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return tree.branches[a].firstNode < tree.branches[b].firstNode;
  });
  for (const std::uint32_t b : order) {
    const formats::Branch& branch = tree.branches[b];
    if (branch.kind != formats::BranchKind::Aneurysm) continue;
    const bool hangs = branch.parentNode != formats::kNoParent;
    const auto parent = static_cast<std::uint32_t>(branch.parentNode);
    if (hangs && isSac(tree, parent)) {
      sacOf[b] = sacOf[tree.branch[parent]];
    } else {
      sacOf[b] = sacs.size();
      sacs.emplace_back().attachment = branch.parentNode;
    }
    addBranch(tree, b, sacs[sacOf[b]]);
  }
  for (SacTree& sac : sacs) describe(tree, sac);
  return sacs;
}

std::vector<SacVessel> vesselsAtNeck(const formats::CenterlineTree& tree, const SacTree& sac,
                                     double clearance) {
  std::vector<SacVessel> vessels;
  if (sac.attachment == formats::kNoParent) return vessels;
  const auto start = static_cast<std::uint32_t>(sac.attachment);
  VesselWalk walk(tree, start);
  std::vector<std::uint32_t> first = walk.firstBeyond(start, clearance);
  // that towards the root has the least index, as parents come before their children
  std::sort(first.begin(), first.end());
  for (const std::uint32_t n : first) {
    const auto r = static_cast<double>(tree.radius[n]);
    const std::uint32_t second = walk.follow(n, kSecondPlace * 2 * r);
    SacVessel vessel;
    vessel.node = n;
    vessel.diameter = r + static_cast<double>(tree.radius[second]);
    const Vector3d towards = toEigen(tree.centre[second]) - toEigen(tree.centre[n]);
    vessel.away = second != n
                      ? towards.normalized()
                      : (toEigen(tree.centre[n]) - toEigen(tree.centre[start])).normalized();
    vessels.push_back(vessel);
  }
  return vessels;
}

}  // namespace lumen::convert
