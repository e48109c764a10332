// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/ends_answer.h"

#include <algorithm>
#include <cstddef>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::engine {

using operations::OpenEnd;

namespace {

std::string listed(const std::vector<const OpenEnd*>& inlets, const formats::CenterlineTree& tree) {
  constexpr std::size_t kMostListed = 6;
  const std::size_t count = std::min(inlets.size(), kMostListed);
  std::string text;
  for (std::size_t k = 0; k < count; ++k)
    text += (k == 0 ? "" : "; ") + formats::printable(tree.branches[inlets[k]->branch].label) +
            " at " + convert::placeText(inlets[k]->place) + ", radius " +
            fixedText(inlets[k]->radius, 2) + " mm";
  if (count < inlets.size()) text += "; and " + std::to_string(inlets.size() - count) + " more";
  return text;
}

}  // namespace

Json openEndsJson(const std::vector<OpenEnd>& ends, const formats::CenterlineTree& tree) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const OpenEnd& end = ends[k];
    rows.push_back({{"number", k + 1},
                    {"branch", tree.branches[end.branch].label},
                    {"node", end.node},
                    {"position", vectorJson(end.place)},
                    {"radius_mm", jsonNumber(end.radius)},
                    {"leaves_volume", end.leavesVolume ? Json(*end.leavesVolume) : Json(nullptr)},
                    {"inlet", end.isInlet},
                    {"why", end.why.empty() ? Json(nullptr) : Json(end.why)}});
  }
  return rows;
}

Json inletsJson(const std::vector<OpenEnd>& ends, const formats::CenterlineTree& tree) {
  Json rows = openEndsJson(ends, tree);
  std::erase_if(rows.get_ref<Json::array_t&>(), [](const Json& row) { return !row["inlet"]; });
  return rows;
}

std::string endTable(const std::vector<OpenEnd>& ends, const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::string>> rows{
      {"end", "branch", "radius", "x", "y", "z", "volume", "blood"}};
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const OpenEnd& end = ends[k];
    const std::string volume = !end.leavesVolume ? "-" : *end.leavesVolume ? "leaves" : "within";
    const std::string blood = end.isInlet       ? "comes in"
                              : end.why.empty() ? ""
                                                : "may come in: " + end.why;
    rows.push_back({std::to_string(k + 1), formats::printable(tree.branches[end.branch].label),
                    fixedText(end.radius, 2), fixedText(end.place.x(), 1),
                    fixedText(end.place.y(), 1), fixedText(end.place.z(), 1), volume,
                    formats::printable(blood)});
  }
  return alignColumns(std::move(rows)) + "Radii and places in mm, LPS.\n";
}

std::string inletsText(const std::vector<OpenEnd>& ends, const formats::CenterlineTree& tree) {
  std::vector<const OpenEnd*> unknown, leaving, within;
  for (const OpenEnd& end : ends)
    if (end.isInlet)
      (!end.leavesVolume ? unknown : *end.leavesVolume ? leaving : within).push_back(&end);
  if (!unknown.empty()) return listed(unknown, tree);
  std::string text = "none leaves the volume";
  if (!leaving.empty())
    text = std::to_string(leaving.size()) + (leaving.size() == 1 ? " leaves" : " leave") +
           " the volume: " + listed(leaving, tree);
  if (!within.empty())
    text += "; " + counted(within.size(), "tree begins", "trees begin") + " within it";
  return text;
}

}  // namespace lumen::engine
