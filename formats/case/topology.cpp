// SPDX-License-Identifier: Apache-2.0
#include "formats/case/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumen::formats {
namespace {

double distance(const Vec3f& a, const Vec3f& b) {
  const double x = double{a.x} - double{b.x};
  const double y = double{a.y} - double{b.y};
  const double z = double{a.z} - double{b.z};
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

Neighbours::Neighbours(const CenterlineTree& tree) : m_offset(tree.nodeCount() + 1, 0) {
  const std::size_t count = tree.nodeCount();
  for (std::size_t i = 0; i < count; ++i)
    if (tree.parent[i] != kNoParent) {
      ++m_offset[i + 1];
      ++m_offset[static_cast<std::size_t>(tree.parent[i]) + 1];
    }
  for (std::size_t i = 0; i < count; ++i) m_offset[i + 1] += m_offset[i];

  // A parent has a smaller index than its children, so parent first, then children in their order,
  // is ascending.
  m_node.resize(m_offset[count]);
  std::vector<std::uint32_t> next(m_offset.begin(), m_offset.end() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (tree.parent[i] == kNoParent) continue;
    const auto parent = static_cast<std::uint32_t>(tree.parent[i]);
    m_node[next[i]++] = parent;
    m_node[next[parent]++] = static_cast<std::uint32_t>(i);
  }
}

std::vector<std::uint32_t> Neighbours::within(std::uint32_t node, int distance) const {
  // In a forest the only way back is the way by which a node was reached.
  constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> found{node}, reachedFrom{kNowhere};
  std::size_t ringBegin = 0;
  for (int ring = 0; ring < distance && ringBegin < found.size(); ++ring) {
    const std::size_t ringEnd = found.size();
    for (std::size_t i = ringBegin; i < ringEnd; ++i)
      for (const std::uint32_t next : of(found[i])) {
        if (next == reachedFrom[i]) continue;
        const std::uint32_t from = found[i];
        found.push_back(next);
        reachedFrom.push_back(from);
      }
    ringBegin = ringEnd;
  }
  return found;
}

double branchLength(const CenterlineTree& tree, const Branch& branch) {
  double length = 0;
  for (std::size_t i = 1; i < branch.nodeCount; ++i) {
    const std::size_t node = branch.firstNode + i;
    length += distance(tree.centre[node - 1], tree.centre[node]);
  }
  if (branch.parentNode != kNoParent && branch.nodeCount > 0) {
    const auto parent = static_cast<std::size_t>(branch.parentNode);
    const double link = distance(tree.centre[parent], tree.centre[branch.firstNode]);
    length += std::max(0.0, link - double{tree.radius[parent]});
  }
  return length;
}

}  // namespace lumen::formats
