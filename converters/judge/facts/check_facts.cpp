// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/facts/check_facts.h"

#include <algorithm>
#include <cmath>

#include "converters/base/number_text.h"
#include "converters/base/text.h"

namespace lumen::convert {

const std::string& labelOf(const formats::CenterlineTree& tree, std::uint32_t node) {
  return tree.branches[tree.branch[node]].label;
}

const Eigen::Vector3d& middleOf(const MissingVessel& vessel) {
  return vessel.path[vessel.path.size() / 2].position;
}

double share(double part, double whole) {
  return whole > 0 ? part / whole : NAN;
}

std::string percentText(double share) {
  return std::isfinite(share) ? fixedText(100 * share, 1) + " %" : "-";
}

std::vector<OpenEnd> endsThatStopShort(const CheckReport& report) {
  std::vector<OpenEnd> onward;
  for (const OpenEnd& end : report.ends)
    if (end.goesOn > 0) onward.push_back(end);
  std::stable_sort(onward.begin(), onward.end(),
                   [](const auto& a, const auto& b) { return a.goesOn > b.goesOn; });
  return onward;
}

std::string SourceRelation::word() const {
  if (!isKnown) return "unknown";
  return difference ? "other " + difference->what : "same";
}

std::optional<std::string> SourceRelation::warning(const std::string& volumeName) const {
  if (!difference) return std::nullopt;
  return "was made from another volume: " +
         (difference->what == "voxels"
              ? volumeName + " has its size and place, but other voxels"
              : "its " + difference->what + " was " + difference->expected + ", that of " +
                    volumeName + " is " + difference->found);
}

SourceRelation sourceRelation(const formats::SourceVolume& volume,
                              const formats::Metadata& metadata) {
  if (!metadata.source) return {};
  return {true, sourceDifference(volume, *metadata.source)};
}

std::optional<std::string> outsideWarning(const CheckReport& report,
                                          const std::string& volumeName) {
  if (report.nodesOutside == 0) return std::nullopt;
  return std::to_string(report.nodesOutside) + " of its " +
         counted(report.nodes.size(), "node lies", "nodes lie") + " outside of " + volumeName;
}

}  // namespace lumen::convert
