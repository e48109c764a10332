// SPDX-License-Identifier: Apache-2.0
// The nodes that a cursor may step to, and whose models blend.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/field/tree_view.h"

namespace lumen::field {

/// Adjacency of all nodes in CSR form, symmetric, ascending within a node.
struct Neighbourhood {
  std::vector<std::uint32_t> offset, node;
  std::vector<bool> isEdge;  ///< per entry of `node`: a parent, child or link
};

/// Adjacency by parents, children and links only. Indices are in range.
Neighbourhood findEdges(const TreeView& tree);

/// The node whose blobs answer for each node: itself if it has some, else the nearest along
/// the tree that has (the fewest edges away; of several, the lowest index), or kNowhere. Node i
/// owns the blobs offset[i] .. offset[i + 1] - 1.
std::vector<std::uint32_t> findLenders(const Neighbourhood& edges, const std::uint32_t* offset);

/// The greatest square of the lengths of a node's edges, mm^2, for all nodes.
std::vector<double> measureSpacings(const TreeView& tree, const Neighbourhood& edges);

/// Blending width tau of a pair, mm^2. For an edge, a share of the square of its length: along a
/// straight chain two models blend in that share of the distance between two nodes, and one is
/// alone near a node. A farther pair blends no wider: it has influence only where its nodes nearly
/// tie. `spacing`: the pair's mean.
double blendingWidth(const TreeView& tree, std::uint32_t i, std::uint32_t k, bool isEdge,
                     double spacing);
/// The width of a pair from the square of its distance, mm^2, and the smaller of its radii, mm.
double blendingWidth(double square, double smallerRadius, bool isEdge, double spacing);

/// Neighbours of all nodes: the edges; nodes two edges apart; and nodes a short path apart along
/// the tree whose balls overlap and whose cells meet or nearly meet, although others lie between:
/// in the bend of a vessel, in the crotch of a bifurcation, past nodes too thin for their
/// neighbours. Then the node of least power among its neighbours is that of least power of all
/// nodes near by along the tree, and a cursor's node does not depend on its path.
Neighbourhood findNeighbourhood(const TreeView& tree, const Neighbourhood& edges);

}  // namespace lumen::field
