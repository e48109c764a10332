// SPDX-License-Identifier: Apache-2.0
// labelLumens() and joinTrees(); growTree() is in grow_tree.cpp.
#include "converters/stages/surface/lattice_topology.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "converters/base/vectors.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

// The vertices around a node's centre that a cursor at the node can reach.
class NodePlaces {
public:
  NodePlaces(const SampledLattice& lattice, const SeparatedField& field)
      : m_lattice(lattice), m_field(field), m_tree(field.source().tree) {}

  [[nodiscard]] std::uint32_t at(std::uint32_t node) const {
    for (const std::uint32_t v : m_lattice.verticesAround(toEigen(m_tree.centre[node])))
      if (m_lattice.isInside(v) && m_field.isReached(m_lattice.place(v), node, m_lattice.node(v)))
        return v;
    return kOutside;
  }

private:
  const SampledLattice& m_lattice;
  const SeparatedField& m_field;
  const formats::CenterlineTree& m_tree;
};

// All vertices of the cubes along an edge become inside, of that edge's sheet.
void openEdge(SampledLattice& lattice, const SeparatedField& field, std::uint32_t from,
              std::uint32_t to) {
  const formats::CenterlineTree& tree = field.source().tree;
  const Eigen::Vector3d a = toEigen(tree.centre[from]), b = toEigen(tree.centre[to]);
  const double step = 0.1 * std::min(field.radius(from), field.radius(to));
  const int count = static_cast<int>(std::ceil((b - a).norm() / step)) + 1;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    for (const std::uint32_t v : lattice.verticesAround(a + t * (b - a)))
      if (!lattice.isOutermost(v))
        lattice.force(v, field.at(lattice.place(v), t < 0.5 ? from : to));
  }
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> findEdges(
    const formats::CenterlineTree& tree) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] >= 0) edges.emplace_back(static_cast<std::uint32_t>(tree.parent[i]), i);
  for (const auto& link : tree.links) edges.emplace_back(link[0], link[1]);
  return edges;
}

// The connected trees; `treeOf` gets the index of each node's.
std::vector<TreeLumen> findTrees(const formats::CenterlineTree& tree,
                                 std::vector<std::uint32_t>& treeOf) {
  DisjointSets sets(tree.nodeCount());
  std::vector<std::size_t> loops(tree.nodeCount(), 0);
  std::vector<std::uint32_t> closing;
  for (const auto& [a, b] : findEdges(tree)) {
    if (sets.find(a) == sets.find(b)) closing.push_back(a);
    sets.join(a, b);
  }
  for (const std::uint32_t node : closing) ++loops[sets.find(node)];
  std::vector<TreeLumen> trees;
  treeOf.resize(tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    treeOf[i] = static_cast<std::uint32_t>(trees.size());
    if (sets.find(i) == i)
      trees.push_back({i, loops[i], kOutside, kOutside});
    else
      treeOf[i] = treeOf[sets.find(i)];
  }
  return trees;
}

// The lumen that holds most nodes of a tree is the tree's, and begins at the first of them: where
// vessels cross, opening one may take the surroundings of single nodes of another.
void chooseLumens(const std::vector<std::uint32_t>& treeOf, const std::vector<std::uint32_t>& at,
                  const std::vector<std::uint32_t>& lumens, std::vector<TreeLumen>& trees) {
  struct Share {
    std::size_t nodes = 0;
    std::uint32_t first = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Share> shares;
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    if (at[i] == kOutside || lumens[at[i]] == kOutside) continue;
    ++shares.try_emplace({treeOf[i], lumens[at[i]]}, Share{0, i}).first->second.nodes;
  }
  std::vector<Share> best(trees.size());
  for (const auto& [of, share] : shares) {
    Share& most = best[of.first];
    if (share.nodes < most.nodes || (share.nodes == most.nodes && share.first > most.first))
      continue;
    most = share;
    trees[of.first].start = at[share.first];
    trees[of.first].lumen = of.second;
  }
}

}  // namespace

std::vector<std::uint32_t> labelLumens(const SampledLattice& lattice) {
  DisjointSets sets(lattice.size());
  lattice.eachTetrahedronInTurn([&](const SampledLattice::Tetrahedron& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!lattice.isInside(t[i])) continue;
      for (std::size_t j = i + 1; j < 4; ++j)
        if (lattice.isInside(t[j]) && lattice.areJoined(t[i], t[j])) sets.join(t[i], t[j]);
    }
  });
  std::vector<std::uint32_t> lumens(lattice.size(), kOutside);
  for (std::uint32_t v = 0; v < lattice.size(); ++v)
    if (lattice.isInside(v)) lumens[v] = sets.find(v);
  return lumens;
}

std::vector<TreeLumen> joinTrees(SampledLattice& lattice, const SeparatedField& field,
                                 std::vector<std::uint32_t>& lumens, std::size_t& opened) {
  const formats::CenterlineTree& tree = field.source().tree;
  const NodePlaces places(lattice, field);
  std::vector<std::uint32_t> at(tree.nodeCount());
  for (std::uint32_t i = 0; i < at.size(); ++i) at[i] = places.at(i);
  const auto lumenAt = [&](std::uint32_t node) {
    return at[node] == kOutside ? kOutside : lumens[at[node]];
  };
  opened = 0;
  for (const auto& [a, b] : findEdges(tree)) {
    if (lumenAt(a) != kOutside && lumenAt(a) == lumenAt(b)) continue;
    openEdge(lattice, field, a, b);
    ++opened;
  }
  if (opened > 0) {
    lattice.update();
    lumens = labelLumens(lattice);
    for (std::uint32_t i = 0; i < at.size(); ++i) at[i] = places.at(i);
  }
  std::vector<std::uint32_t> treeOf;
  std::vector<TreeLumen> trees = findTrees(tree, treeOf);
  chooseLumens(treeOf, at, lumens, trees);
  std::vector<bool> isKept(lattice.size(), false);
  for (const TreeLumen& one : trees)
    if (one.lumen != kOutside) isKept[one.lumen] = true;
  for (std::uint32_t v = 0; v < lattice.size(); ++v) {
    if (lumens[v] == kOutside || isKept[lumens[v]]) continue;
    lattice.setInside(v, false);
    lumens[v] = kOutside;
  }
  return trees;
}

}  // namespace lumen::convert
