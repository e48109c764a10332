// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/facts/case_info.h"

#include <span>

#include "converters/base/error.h"
#include "converters/base/warning.h"
#include "converters/judge/facts/branch_end.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/judge/measure/vessel_length.h"
#include "formats/case/enum_names.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

namespace {

BranchInfo describeBranch(const formats::CenterlineTree& tree, const formats::Branch& branch,
                          double length) {
  BranchInfo info;
  info.label = branch.label;
  info.kind = formats::enumName(formats::kBranchKindNames, branch.kind);
  info.nodes = branch.nodeCount;
  info.length = length;
  if (branch.nodeCount > 0)
    info.radius = radiusRange(std::span(tree.radius).subspan(branch.firstNode, branch.nodeCount));
  info.stopReason = formats::enumName(formats::kStopReasonNames, branch.stopReason);
  info.inlierRate = branch.meanInlierRate;
  if (branch.parentNode != formats::kNoParent)
    info.parent = tree.branches[tree.branch[static_cast<std::size_t>(branch.parentNode)]].label;
  return info;
}

MotionInfo describeMotion(const formats::CenterlineTree& tree, const formats::Motion& motion) {
  return {motion.time.size(), motion.node.size(), motion.time.front(),
          motion.time.back(), motion.period,      formats::motionFigures(tree, motion)};
}

}  // namespace

CaseInfo describeCase(const formats::Case& value, Progress& progress) {
  CaseInfo info;
  info.nodes = value.tree.nodeCount();
  if (value.points) info.points = value.points->position.size();
  if (value.models) info.blobs = value.models->centre.size();
  info.links = value.tree.links.size();
  info.trees = countTrees(value.tree);
  info.networks = countNetworks(value.tree);
  if (value.motion) info.motion = describeMotion(value.tree, *value.motion);
  for (const auto& array : value.nodeArrays) info.nodeArrays.push_back(array.name);
  try {
    info.seeds = countSeeds(value, "the case");
  } catch (const Error& error) {
    warn(progress, {WarningCode::CaseSeeds, error.what()});
  }
  const VesselLengths lengths = vesselLengths(value.tree);
  info.length = lengths.total;
  if (info.nodes > 0) info.radius = radiusRange(value.tree.radius);
  info.leastShown = leastShownRadius(value.metadata);
  info.errorOfFit = fittedError(value, progress);
  info.reach = measureReach(value, progress);
  const std::vector<std::string> ends = describeEnds(value);
  for (std::size_t b = 0; b < ends.size(); ++b) {
    info.branches.push_back(describeBranch(value.tree, value.tree.branches[b], lengths.branch[b]));
    info.branches.back().end = ends[b];
  }
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(value);
  for (std::size_t b = 0; b < systems.size(); ++b)
    info.branches[b].system = formats::kVesselSystemNames[static_cast<std::size_t>(systems[b])];
  info.metadata = value.metadata;
  return info;
}

}  // namespace lumen::convert
