// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/facts/branch_end.h"

#include <cstddef>

#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/trim.h"

namespace lumen::convert {

namespace {

using formats::StopReason;

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  return text;
}

/// The vessel in which a branch's last node lies, besides its own; empty if there is none.
std::string vesselMet(const formats::CenterlineTree& tree, std::uint32_t branch,
                      std::uint32_t last) {
  std::string name;
  double least = 1;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    if (b == branch || tree.branches[b].kind != formats::BranchKind::Vessel) continue;
    const auto place = placeIn(tree, b, toEigen(tree.centre[last]));
    if (!place || place->share > least) continue;
    least = place->share;
    name = tree.branches[b].label;
  }
  return name;
}

std::string reasonText(const formats::CenterlineTree& tree, std::uint32_t branch,
                       std::uint32_t last) {
  switch (tree.branches[branch].stopReason) {
    case StopReason::NoValidCylinder:
      return "fades: the edges show no cylinder beyond";
    case StopReason::TurnedBack:
      return "turned back on itself at";
    case StopReason::LeftVolume:
      return "leaves the volume at";
    case StopReason::MetBranch: {
      const std::string met = vesselMet(tree, branch, last);
      return met.empty() ? "met another vessel at" : "met " + met + " at";
    }
    case StopReason::EndOfSeeds:
      return "ends where its seeds end, at";
    case StopReason::StepLimit:
      return "reached the greatest number of nodes at";
    case StopReason::Unknown:
      break;
  }
  return "ends at";
}

}  // namespace

std::vector<std::string> describeEnds(const formats::Case& value) {
  const formats::CenterlineTree& tree = value.tree;
  std::vector<std::vector<std::string>> goesOn(tree.nodeCount()), linked(tree.nodeCount());
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    if (const std::int32_t parent = tree.branches[b].parentNode; parent != formats::kNoParent)
      goesOn[static_cast<std::size_t>(parent)].push_back(tree.branches[b].label);
  for (const auto& [first, second] : tree.links) {
    linked[first].push_back(tree.branches[tree.branch[second]].label);
    linked[second].push_back(tree.branches[tree.branch[first]].label);
  }
  std::vector<std::string> ends;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    if (branch.nodeCount == 0) {
      ends.emplace_back("has no nodes");
      continue;
    }
    const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
    const bool isBorder = branch.kind == formats::BranchKind::Vessel && value.metadata.source &&
                          isAtBorder(*value.metadata.source, tree, last);
    const std::string what = !goesOn[last].empty() ? "goes on as " + listed(goesOn[last]) + " at"
                             : !linked[last].empty()
                                 ? "is linked with " + listed(linked[last]) + " at"
                             : isBorder ? "leaves the volume at"
                                        : reasonText(tree, b, last);
    ends.push_back(what + " " + placeText(toEigen(tree.centre[last])));
  }
  return ends;
}

}  // namespace lumen::convert
