// SPDX-License-Identifier: Apache-2.0
// The nodes of a case's trees and links as one graph without directions.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/base/vectors.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A set of nodes, one value each; empty: none.
using NodeSet = std::vector<bool>;

class VesselNetwork {
public:
  explicit VesselNetwork(const formats::CenterlineTree& tree);

  /// The measure of a way.
  enum class WayCost : std::uint8_t {
    Length,     ///< mm
    Resistance  ///< length over the fourth power of the radius, mm^-3, as of a steady flow
  };
  /// The cheapest ways from one node to all.
  struct Ways {
    std::vector<double> cost;           ///< infinite where no way leads
    std::vector<std::uint32_t> before;  ///< the node before each; kNone for the first
    [[nodiscard]] bool reach(std::uint32_t node) const {
      return cost[node] < std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] std::vector<std::uint32_t> reached() const;  ///< all nodes that are, in order
    /// The nodes from the first to one that is reached, with both.
    [[nodiscard]] std::vector<std::uint32_t> to(std::uint32_t node) const;
  };
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// Ways that enter none of the nodes in `closed` and cost at most `most`.
  [[nodiscard]] Ways waysFrom(std::uint32_t node, const NodeSet& closed = {},
                              WayCost cost = WayCost::Length,
                              double most = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] const std::vector<std::uint32_t>& neighbours(std::uint32_t node) const {
    return m_neighbours[node];
  }
  /// Nodes with one neighbour.
  [[nodiscard]] const std::vector<std::uint32_t>& ends() const { return m_ends; }
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t node) const {  ///< mm, LPS
    return toEigen(m_tree.centre[node]);
  }
  [[nodiscard]] double radius(std::uint32_t node) const {
    return double{m_tree.radius[node]};
  }                                                                         ///< mm
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const;      ///< of an edge, mm
  [[nodiscard]] double lengthOf(std::span<const std::uint32_t> way) const;  ///< mm
  [[nodiscard]] double medianRadius(std::span<const std::uint32_t> nodes) const;  ///< mm; 0 of none
  [[nodiscard]] NodeSet setOf(std::span<const std::uint32_t> nodes) const;

private:
  const formats::CenterlineTree& m_tree;
  std::vector<std::vector<std::uint32_t>> m_neighbours;
  std::vector<std::uint32_t> m_ends;
};

}  // namespace lumen::convert
