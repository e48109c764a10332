// SPDX-License-Identifier: Apache-2.0
// Walks on a centerline tree. Edges are those of the format; field::findEdges() drops duplicates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// Topological neighbours (parent, children, and the nodes that links join to it) of every node, in
/// CSR form, ascending within a node.
class Neighbours {
public:
  explicit Neighbours(const CenterlineTree& tree);
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t node) const {
    return std::span(m_node).subspan(m_offset[node], m_offset[node + 1] - m_offset[node]);
  }
  /// Nodes within `distance` edges of `node`, itself first, then by distance.
  [[nodiscard]] std::vector<std::uint32_t> within(std::uint32_t node, int distance) const;

private:
  std::vector<std::uint32_t> m_offset, m_node;
};

/// Length of the edge from a node's parent, mm; for a branch's first node, the part outside of the
/// parent's ball; zero without a parent.
double edgeLength(const CenterlineTree& tree, std::uint32_t node);

/// Length of a branch, mm: the sum over the edges of all its nodes.
double branchLength(const CenterlineTree& tree, const Branch& branch);

}  // namespace lumen::formats
