// SPDX-License-Identifier: Apache-2.0
// Trees, ends and paths of a graph that no direction of its edges changes.
#include <algorithm>

#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {

bool NodeGraph::hasAneurysm(std::uint32_t node) const {
  return std::any_of(m_edited.branches.begin(), m_edited.branches.end(), [&](const auto& branch) {
    return branch.record.kind != formats::BranchKind::Vessel && branch.parent == node;
  });
}

void NodeGraph::hangOn(std::uint32_t node, std::uint32_t from) {
  for (auto& link : m_edited.links)
    for (std::uint32_t& end : link)
      if (end == from) end = node;
  std::erase_if(m_edited.links, [](const auto& link) { return link[0] == link[1]; });
  for (EditableBranch& branch : m_edited.branches)
    if (branch.record.kind != formats::BranchKind::Vessel && branch.parent == from)
      branch.parent = node;
}

std::vector<std::uint32_t> NodeGraph::unforkedFrom(std::uint32_t end) const {
  const auto isLeft = [&](std::uint32_t node) {
    return m_neighbours[node].size() > 2 || hasAneurysm(node);
  };
  std::vector<std::uint32_t> nodes;
  std::uint32_t before = kNoNode, next = kNoNode;
  for (std::uint32_t i = end; i != kNoNode && !isLeft(i); before = i, i = next) {
    nodes.push_back(i);
    next = kNoNode;
    for (const std::uint32_t j : m_neighbours[i])
      if (j != before) next = j;
  }
  return nodes;
}

std::size_t NodeGraph::countMeasured(std::span<const std::uint32_t> nodes) const {
  return static_cast<std::size_t>(
      std::count_if(nodes.begin(), nodes.end(), [&](std::uint32_t node) {
        return m_edited.nodes[node].origin == formats::NodeOrigin::Measured;
      }));
}

std::vector<std::uint32_t> NodeGraph::treeOf(std::uint32_t node) const {
  std::vector<bool> isSeen(m_neighbours.size(), false);
  std::vector<std::uint32_t> reached{node};
  isSeen[node] = true;
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const std::uint32_t j : m_neighbours[reached[k]]) {
      if (!isSeen[j]) reached.push_back(j);
      isSeen[j] = true;
    }
  return reached;
}

std::vector<std::uint32_t> NodeGraph::nodesAwayFromEnds() const {
  std::vector<bool> isSide = m_isVessel;
  for (const std::vector<std::uint32_t>& ends : endsOfTrees())
    for (const std::uint32_t end : ends)
      for (const std::uint32_t node : unforkedFrom(end)) {
        if ((position(node) - position(end)).norm() > 2 * radius(end)) break;
        isSide[node] = false;
      }
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < isSide.size(); ++i)
    if (isSide[i]) nodes.push_back(i);
  return nodes;
}

std::vector<std::uint32_t> NodeGraph::pathBetween(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> before(m_neighbours.size(), kNoNode), reached{b};
  before[b] = b;
  for (std::size_t k = 0; k < reached.size() && before[a] == kNoNode; ++k)
    for (const std::uint32_t j : m_neighbours[reached[k]])
      if (before[j] == kNoNode) {
        before[j] = reached[k];
        reached.push_back(j);
      }
  if (before[a] == kNoNode) return {};
  std::vector<std::uint32_t> nodes{a};
  while (nodes.back() != b) nodes.push_back(before[nodes.back()]);
  return nodes;
}

std::optional<double> NodeGraph::pathLength(std::uint32_t a, std::uint32_t b) const {
  const std::vector<std::uint32_t> nodes = pathBetween(a, b);
  if (nodes.empty()) return std::nullopt;
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    length += (position(nodes[i]) - position(nodes[i - 1])).norm();
  return length;
}

double NodeGraph::treeLength(std::uint32_t node) const {
  double length = 0;
  for (const std::uint32_t i : treeOf(node))
    for (const std::uint32_t j : m_neighbours[i])
      if (i < j) length += (position(i) - position(j)).norm();
  return length;
}

std::vector<std::vector<std::uint32_t>> NodeGraph::endsOfTrees() const {
  std::vector<std::vector<std::uint32_t>> out;
  std::vector<bool> isSeen(m_neighbours.size(), false);
  for (std::uint32_t i = 0; i < m_neighbours.size(); ++i) {
    if (isSeen[i] || !m_isVessel[i]) continue;
    std::vector<std::uint32_t> tree{i}, ends;
    isSeen[i] = true;
    for (std::size_t k = 0; k < tree.size(); ++k) {
      if (m_neighbours[tree[k]].size() < 2) ends.push_back(tree[k]);
      for (const std::uint32_t j : m_neighbours[tree[k]]) {
        if (!isSeen[j]) tree.push_back(j);
        isSeen[j] = true;
      }
    }
    out.push_back(std::move(ends));
  }
  return out;
}

}  // namespace lumen::convert
