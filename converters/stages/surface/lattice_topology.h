// SPDX-License-Identifier: Apache-2.0
// Makes the inside of a lattice what a tree is: connected, with a handle for each link and none
// besides.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/surface/sampled_lattice.h"

namespace lumen::convert {

/// The connected parts of what is inside: of each vertex the least one of its part, or kOutside.
constexpr std::uint32_t kOutside = UINT32_MAX;
std::vector<std::uint32_t> lumensOf(const SampledLattice& lattice);

/// A connected component of the centerline tree.
struct TreeLumen {
  std::uint32_t node = 0;   ///< the first node
  std::size_t links = 0;    ///< how many loops its edges and links close
  std::uint32_t start = 0;  ///< a vertex in its lumen, at the first node
  std::uint32_t lumen = 0;  ///< as lumensOf() names it
};

/// Opens the tree edges along which no lumen leads from end to end, by a way as wide as a cube, and
/// puts outside what is inside but not joined to any node. Returns the trees, and in
/// `opened` the number of edges. `lumens` is brought up to date.
std::vector<TreeLumen> joinTrees(SampledLattice& lattice, const SheetField& field,
                                 std::vector<std::uint32_t>& lumens, std::size_t& opened);

/// Grows the inside of one tree anew, without handles but one for each link: from its first node by
/// vertices that do not change the topology (simple points: G. Bertrand, G. Malandain, *A new
/// characterization of three-dimensional simple points*, 1994), along the axes first, then
/// deepest places first, so a handle is cut where it is shallowest. What is not reached is put
/// outside; returns the places, mm, one for each connected group.
std::vector<Eigen::Vector3d> growTree(SampledLattice& lattice, const SheetField& field,
                                      const TreeLumen& tree,
                                      const std::vector<std::uint32_t>& lumens);

}  // namespace lumen::convert
