// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/compare.h"

#include <algorithm>

#include "converters/base/error.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

constexpr double kFinestStep =
    1.0 / 6000;  // relative to the longest branch: bounds the memory of a correspondence
constexpr double kCoarsestStep = 0.1;  // mm

double samplingStep(const formats::Case& found, const formats::Case& truth) {
  double step = kCoarsestStep;
  if (truth.metadata.voxelSize) step = std::min(step, 0.25 * *truth.metadata.voxelSize);
  for (const formats::Case* value : {&found, &truth})
    for (const formats::Branch& branch : value->tree.branches)
      step = std::max(step, kFinestStep * formats::branchLength(value->tree, branch));
  return step;
}

}  // namespace

Comparison compareCases(const formats::Case& found, const formats::Case& truth,
                        Progress& progress) {
  if (truth.tree.branches.empty())
    throw invalidInput(
        "the truth has no branch, so there is nothing to compare with; expected a case with a "
        "tree");
  progress.begin("compare",
                 truth.tree.branches.size() + (found.models ? found.tree.nodeCount() : 0));
  const CenterlineComparison lines =
      compareCenterlines(found.tree, truth.tree, samplingStep(found, truth), progress);
  WallComparison walls;
  walls.branch.resize(truth.tree.branches.size());
  if (found.models) walls = compareWalls(found, truth.tree, progress);
  Comparison result;
  result.score = lines.all;
  result.wallDistance = walls.all;
  for (std::size_t b = 0; b < truth.tree.branches.size(); ++b)
    result.branches.push_back({truth.tree.branches[b].label, lines.branch[b], walls.branch[b]});
  progress.end();
  return result;
}

}  // namespace lumen::convert
