// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/facts/reachable.h"

#include <algorithm>

#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/judge/measure/vessel_length.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "formats/container/printable.h"

namespace lumen::convert {

std::size_t countTrees(const formats::CenterlineTree& tree) {
  return static_cast<std::size_t>(std::count_if(
      tree.branches.begin(), tree.branches.end(),
      [](const formats::Branch& branch) { return branch.parentNode == formats::kNoParent; }));
}

std::size_t countNetworks(const formats::CenterlineTree& tree) {
  DisjointSets parts(tree.branches.size());
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    if (const std::int32_t parent = tree.branches[b].parentNode; parent != formats::kNoParent)
      parts.join(b, tree.branch[static_cast<std::size_t>(parent)]);
  for (const auto& link : tree.links) parts.join(tree.branch[link[0]], tree.branch[link[1]]);
  std::size_t count = 0;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) count += parts.find(b) == b ? 1 : 0;
  return count;
}

std::optional<Reach> measureReach(const formats::Case& value, const Progress& progress) {
  if (!value.models) return std::nullopt;
  const auto found = formats::measureReachability(value.tree, formats::caseField(value),
                                                  [&progress] { progress.check(); });
  const VesselLengths lengths = vesselLengths(value.tree);
  Reach reach;
  for (const formats::Barrier& barrier : found.barriers)
    reach.closed.push_back({value.tree.branches[value.tree.branch[barrier.node]].label,
                            barrier.node, barrier.place, 0});
  for (std::size_t n = 0; n < lengths.edge.size(); ++n) {
    const std::int32_t barrier = found.barrierOf[n];
    (barrier < 0 ? reach.length : reach.closed[static_cast<std::size_t>(barrier)].beyond) +=
        lengths.edge[n];
  }
  reach.of = lengths.total;
  const std::vector<TreeExtent> trees = listTrees(value.tree, lengths);
  reach.trees = trees.size();
  reach.networks = countNetworks(value.tree);
  if (!trees.empty()) reach.longest = trees.front().length;
  std::stable_sort(reach.closed.begin(), reach.closed.end(),
                   [](const ClosedPath& a, const ClosedPath& b) { return a.beyond > b.beyond; });
  return reach;
}

std::string reachText(const std::optional<Reach>& reach) {
  if (!reach) return "not known, as there are no models (lumen fit makes them)";
  const std::string text = fixedText(reach->length, 1) + " of " + fixedText(reach->of, 1) + " mm";
  if (reach->trees < 2) return text;
  return text + ", from the roots of " + std::to_string(reach->trees) +
         " trees, each of which is reached from its own; they hang together in " +
         counted(reach->networks, "network", "networks") + ", and the longest tree has " +
         fixedText(reach->longest, 1) + " mm";
}

std::string reachLine(const std::optional<Reach>& reach) {
  return "reachable: " + reachText(reach) + "\n";
}

std::string closedText(const ClosedPath& path) {
  return "branch " + formats::printable(path.branch) + " is closed before node " +
         std::to_string(path.node) + " at " +
         placeText({path.position.x, path.position.y, path.position.z}) + ": " +
         fixedText(path.beyond, 1) + " mm beyond cannot be reached";
}

std::vector<std::string> closedTexts(const Reach& reach) {
  constexpr std::size_t kMostClosedTexts = 10;
  const std::size_t count = std::min(reach.closed.size(), kMostClosedTexts);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) texts.push_back(closedText(reach.closed[i]));
  if (const std::size_t more = reach.closed.size() - count; more > 0)
    texts.push_back("closed at " + counted(more, "place more", "places more") + "; lumen info " +
                    kOption.json.shown() + " lists all");
  return texts;
}

void warnOfClosed(const std::optional<Reach>& reach, Progress& progress) {
  if (!reach) return;
  for (const std::string& text : closedTexts(*reach))
    warn(progress, {WarningCode::LumenClosed, text});
}

}  // namespace lumen::convert
