// SPDX-License-Identifier: Apache-2.0
#include "neighbours.h"

#include <algorithm>
#include <cmath>

namespace lumen::blob {
namespace {

using field::Neighbourhood;
using field::TreeView;

// A neighbour of a node, as a lane of a block, and the distance from the node at which it begins to
// blend.
struct Neighbour {
  float nx, ny, nz, c, inverseTau;
  std::uint32_t node;
  double begin;  // mm
};

// The distance from a node's centre within which, rounding included, the node beats a neighbour by
// tau: p_k - p_i >= c - |n| |x|.
double beginOfBlending(const double* offset, double c, double tau) {
  constexpr double kRounding = 1e-5;
  const double slope =
      2.0 * std::sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const double margin = c - tau - kRounding * (std::abs(c) + tau);
  if (!(margin > 0)) return 0;
  return slope > 0 ? margin / (slope * (1.0 + kRounding)) : kFarthestMm;
}

Neighbour makeNeighbour(const TreeView& tree, std::uint32_t i, std::uint32_t k, bool isEdge,
                        double spacing) {
  double offset[3], square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = double{tree.centre[k][axis]} - double{tree.centre[i][axis]};
    square += offset[axis] * offset[axis];
  }
  const double ri = tree.radius[i], rk = tree.radius[k], c = square - rk * rk + ri * ri;
  const double tau = field::blendingWidth(tree, i, k, isEdge, spacing);
  return {static_cast<float>(-2.0 * offset[0]), static_cast<float>(-2.0 * offset[1]),
          static_cast<float>(-2.0 * offset[2]), static_cast<float>(c),
          static_cast<float>(1.0 / tau),        k,
          beginOfBlending(offset, c, tau)};
}

void setLane(const Neighbour& neighbour, std::size_t lane, NeighbourBlock& block) {
  block.nx[lane] = neighbour.nx;
  block.ny[lane] = neighbour.ny;
  block.nz[lane] = neighbour.nz;
  block.c[lane] = neighbour.c;
  block.inverseTau[lane] = neighbour.inverseTau;
  block.node[lane] = neighbour.node;
}

// Appends the neighbours of node i.
void addNeighboursOf(const TreeView& tree, const Neighbourhood& around,
                     const std::vector<double>& spacing, std::uint32_t i, NodeRecord& record,
                     std::vector<NeighbourBlock>& blocks) {
  std::vector<Neighbour> sorted;
  for (std::uint32_t e = around.offset[i]; e < around.offset[i + 1]; ++e)
    sorted.push_back(makeNeighbour(tree, i, around.node[e], around.isEdge[e],
                                   0.5 * (spacing[i] + spacing[around.node[e]])));
  std::sort(sorted.begin(), sorted.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.node < b.node;
  });
  const std::size_t first = blocks.size(),
                    count = std::max<std::size_t>(1, (sorted.size() + kLanes - 1) / kLanes);
  NeighbourBlock empty{};
  std::fill_n(empty.c, kLanes, kNeverLess);
  std::fill_n(empty.inverseTau, kLanes, 1.0f);
  std::fill_n(empty.node, kLanes, BLOB_NOWHERE);
  blocks.resize(first + count, empty);
  for (std::size_t e = 0; e < sorted.size(); ++e)
    setLane(sorted[e], e % kLanes, blocks[first + e / kLanes]);
  const double quiet = count > 1 ? sorted[kLanes].begin : kFarthestMm;
  record.centre[3] = quiet * quiet;
  record.firstNeighbours = static_cast<std::uint32_t>(first);
  record.neighbourBlocks = static_cast<std::uint32_t>(count);
}

}  // namespace

void addNeighbours(const TreeView& tree, const Neighbourhood& around,
                   const std::vector<double>& spacing, std::vector<NodeRecord>& nodes,
                   std::vector<NeighbourBlock>& blocks) {
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    addNeighboursOf(tree, around, spacing, i, nodes[i], blocks);
}

}  // namespace lumen::blob
