// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/vessel_length.h"

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

#include "converters/judge/measure/vessel_course.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

void addCurved(const VesselCourse& course, std::vector<double>& edge) {
  double before = 0;
  for (std::size_t i = 0; i < course.nodes.size(); ++i) {
    const double along = std::max(0.0, course.gap + course.axis->alongOf(i) - course.begin);
    edge[course.nodes[i]] = along - before;
    before = along;
  }
}

double addBranch(const CenterlineTree& tree, std::uint32_t index, std::vector<double>& edge) {
  const formats::Branch& branch = tree.branches[index];
  const VesselCourse course = vesselCourse(tree, index);
  const std::uint32_t end = branch.firstNode + branch.nodeCount;
  if (course.axis)
    addCurved(course, edge);
  else
    for (std::uint32_t n = branch.firstNode; n < end; ++n) edge[n] = formats::edgeLength(tree, n);
  double length = 0;
  for (std::uint32_t n = branch.firstNode; n < end; ++n) length += edge[n];
  return length;
}

}  // namespace

VesselLengths vesselLengths(const CenterlineTree& tree) {
  VesselLengths lengths;
  lengths.edge.resize(tree.nodeCount());
  lengths.branch.resize(tree.branches.size());
  tbb::parallel_for(std::size_t{0}, lengths.branch.size(), [&](std::size_t b) {
    lengths.branch[b] = addBranch(tree, static_cast<std::uint32_t>(b), lengths.edge);
  });
  for (const double length : lengths.branch) lengths.total += length;
  return lengths;
}

std::vector<TreeExtent> listTrees(const CenterlineTree& tree, const VesselLengths& lengths) {
  std::vector<TreeExtent> trees;
  std::vector<std::size_t> treeOf(tree.branches.size());
  for (std::uint32_t b = 0; b < treeOf.size(); ++b) {  // a parent stands before those that leave it
    const std::int32_t from = tree.branches[b].parentNode;
    const bool isRoot = from == formats::kNoParent;
    treeOf[b] = isRoot ? trees.size() : treeOf[tree.branch[static_cast<std::size_t>(from)]];
    if (isRoot) trees.push_back({b});
    ++trees[treeOf[b]].branches;
    trees[treeOf[b]].length += lengths.branch[b];
  }
  std::stable_sort(trees.begin(), trees.end(),
                   [](const TreeExtent& a, const TreeExtent& b) { return a.length > b.length; });
  return trees;
}

}  // namespace lumen::convert
