// SPDX-License-Identifier: Apache-2.0
// Topology of the inside of a lattice by that of a tree: connected, with one handle for each link
// and no others.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/surface/sampled_lattice.h"

namespace lumen::convert {

/// The connected parts of the inside: for each vertex the least one of its part, or kOutside.
constexpr std::uint32_t kOutside = UINT32_MAX;
std::vector<std::uint32_t> labelLumens(const SampledLattice& lattice);

/// A connected component of the centerline tree.
struct TreeLumen {
  std::uint32_t node = 0;   ///< the first node
  std::size_t links = 0;    ///< number of loops that its edges and links close
  std::uint32_t start = 0;  ///< a vertex in its lumen, at the first node that is in it
  std::uint32_t lumen = 0;  ///< the part that holds most of its nodes, as numbered by labelLumens()
};

/// Opens the tree edges along which no lumen leads from end to end, by a passage as wide as a cube,
/// and puts outside any part that is joined to no node. Returns the trees, and in `opened` the
/// number of edges. `lumens` is brought up to date.
std::vector<TreeLumen> joinTrees(SampledLattice& lattice, const SeparatedField& field,
                                 std::vector<std::uint32_t>& lumens, std::size_t& opened);

/// Grows the inside of one tree anew, without handles but one for each link: from its first node by
/// vertices that do not change the topology (simple points: G. Bertrand, G. Malandain, *A new
/// characterization of three-dimensional simple points*, 1994), along the axes first, then deepest
/// places first, so a handle is cut where it is shallowest. Vertices that are not reached are put
/// outside; returns their places, mm, one for each connected group.
std::vector<Eigen::Vector3d> growTree(SampledLattice& lattice, const SeparatedField& field,
                                      const TreeLumen& tree,
                                      const std::vector<std::uint32_t>& lumens);

}  // namespace lumen::convert
