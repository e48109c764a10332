// SPDX-License-Identifier: Apache-2.0
#include "converters/app/case_info.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "converters/app/report.h"
#include "formats/case/enum_names.h"
#include "formats/case/topology.h"

namespace lumen::app {

namespace {

RadiusRange radiusRange(std::span<const float> radii) {
  double sum = 0;
  for (const float r : radii) sum += static_cast<double>(r);
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  return {*low, static_cast<float>(sum / static_cast<double>(radii.size())), *high};
}

BranchInfo describeBranch(const formats::CenterlineTree& tree, const formats::Branch& branch) {
  BranchInfo info;
  info.label = branch.label;
  info.kind = formats::enumName(formats::kBranchKindNames, branch.kind);
  info.nodes = branch.nodeCount;
  info.length = formats::branchLength(tree, branch);
  if (branch.nodeCount > 0)
    info.radius = radiusRange(std::span(tree.radius).subspan(branch.firstNode, branch.nodeCount));
  info.stopReason = formats::enumName(formats::kStopReasonNames, branch.stopReason);
  info.inlierRate = branch.meanInlierRate;
  return info;
}

}  // namespace

int fittedNeighbourhood(const formats::Metadata& metadata) {
  for (auto step = metadata.steps.rbegin(); step != metadata.steps.rend(); ++step) {
    if (step->name != "fit") continue;
    const auto found = step->parameters.find("neighbourhood");
    if (found == step->parameters.end()) break;
    if (const auto* value = std::get_if<std::int64_t>(&found->second))
      return static_cast<int>(std::clamp<std::int64_t>(*value, 0, 100));
  }
  return 2;
}

namespace {

std::optional<convert::ErrorOfFitSummary> describeError(const formats::Case& value,
                                                        Progress& progress) {
  if (!value.points || !value.models) return std::nullopt;
  const int neighbourhood = fittedNeighbourhood(value.metadata);
  const auto summary =
      convert::summariseErrorOfFit(convert::errorOfFit(value, neighbourhood, progress));
  if (std::isnan(summary.median)) return std::nullopt;
  return summary;
}

}  // namespace

CaseInfo describeCase(const formats::Case& value, Progress& progress) {
  CaseInfo info;
  info.nodes = value.tree.nodeCount();
  if (value.points) info.points = value.points->position.size();
  if (value.models) info.blobs = value.models->centre.size();
  info.links = value.tree.links.size();
  for (const auto& array : value.nodeArrays) info.nodeArrays.push_back(array.name);
  info.length = totalLength(value.tree);
  if (info.nodes > 0) info.radius = radiusRange(value.tree.radius);
  info.errorOfFit = describeError(value, progress);
  info.reach = reachOf(value, progress);
  for (const auto& branch : value.tree.branches)
    info.branches.push_back(describeBranch(value.tree, branch));
  info.metadata = value.metadata;
  return info;
}

}  // namespace lumen::app
