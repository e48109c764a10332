// SPDX-License-Identifier: Apache-2.0
#include "formats/case/topology.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

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
  const auto eachPair = [&tree, count](auto take) {
    for (std::size_t i = 0; i < count; ++i)
      if (tree.parent[i] != kNoParent)
        take(static_cast<std::uint32_t>(tree.parent[i]), static_cast<std::uint32_t>(i));
    for (const auto& [a, b] : tree.links) take(a, b);
  };
  eachPair([this](std::uint32_t a, std::uint32_t b) {
    ++m_offset[a + 1];
    ++m_offset[b + 1];
  });
  for (std::size_t i = 0; i < count; ++i) m_offset[i + 1] += m_offset[i];
  m_node.resize(m_offset[count]);
  std::vector<std::uint32_t> next(m_offset.begin(), m_offset.end() - 1);
  eachPair([&](std::uint32_t a, std::uint32_t b) {
    m_node[next[a]++] = b;
    m_node[next[b]++] = a;
  });
  for (std::size_t i = 0; i < count; ++i)
    std::sort(m_node.begin() + m_offset[i], m_node.begin() + m_offset[i + 1]);
}

std::vector<std::uint32_t> Neighbours::within(std::uint32_t node, int distance) const {
  std::vector<std::uint32_t> found{node};
  std::unordered_set<std::uint32_t> seen{node};
  std::size_t ringBegin = 0;
  for (int ring = 0; ring < distance && ringBegin < found.size(); ++ring) {
    const std::size_t ringEnd = found.size();
    for (std::size_t i = ringBegin; i < ringEnd; ++i)
      for (const std::uint32_t next : of(found[i]))
        if (seen.insert(next).second) found.push_back(next);
    ringBegin = ringEnd;
  }
  return found;
}

double edgeLength(const CenterlineTree& tree, std::uint32_t node) {
  if (tree.parent[node] == kNoParent) return 0;
  const auto parent = static_cast<std::size_t>(tree.parent[node]);
  const double length = distance(tree.centre[parent], tree.centre[node]);
  if (tree.branch[parent] == tree.branch[node]) return length;
  return std::max(0.0, length - double{tree.radius[parent]});
}

double branchLength(const CenterlineTree& tree, const Branch& branch) {
  double length = 0;
  for (std::uint32_t i = 1; i < branch.nodeCount; ++i)
    length += edgeLength(tree, branch.firstNode + i);
  if (branch.nodeCount > 0) length += edgeLength(tree, branch.firstNode);
  return length;
}

}  // namespace lumen::formats
