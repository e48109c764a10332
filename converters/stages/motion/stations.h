// SPDX-License-Identifier: Apache-2.0
// Some nodes of a tree, about a radius apart, at which its motion is sought (docs/method.md, section 12).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// Stations are nodes: the roots, the ends of branches, the nodes that branches hang on, and nodes
/// between, at least a radius apart and as far from the end of their branch. They ascend, so a parent comes before its children.
struct Stations {
  std::vector<std::uint32_t> node;
  std::vector<std::int32_t> parent;  ///< the station above, or -1
  std::vector<double> gap;           ///< mm along the tree from the parent; 0 without one
  std::vector<double> length;        ///< mm of vessel that a station stands for
  std::vector<int>
      end;  ///< 1 for a tip, -1 for a root with one edge, by the direction that leads out; else 0

  /// A node's stations above and below it, itself twice if it is one, and its share of the way.
  struct Between {
    std::uint32_t above, below;
    double share;
  };
  std::vector<Between> between;  ///< one for each node of the tree

  [[nodiscard]] std::size_t size() const { return node.size(); }
  /// Moves of all nodes from those of the stations, linear in the way along the tree.
  [[nodiscard]] std::vector<Eigen::Vector3d> spread(
      const std::vector<Eigen::Vector3d>& moves) const;
};

Stations placeStations(const formats::CenterlineTree& tree);

}  // namespace lumen::convert
