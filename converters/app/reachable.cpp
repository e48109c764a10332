// SPDX-License-Identifier: Apache-2.0
#include "converters/app/reachable.h"

#include <algorithm>

#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "formats/container/printable.h"

namespace lumen::app {

std::optional<Reach> reachOf(const formats::Case& value) {
  if (!value.models) return std::nullopt;
  const auto found = formats::reachabilityOf(value.tree, formats::blendedFieldOf(value));
  Reach reach{found.reachable, found.total, {}};
  for (const formats::Barrier& barrier : found.barriers) {
    const formats::Branch& branch = value.tree.branches[value.tree.branch[barrier.node]];
    reach.closed.push_back({branch.label, barrier.node - branch.firstNode, barrier.node,
                            barrier.place, barrier.beyond});
  }
  return reach;
}

std::string reachText(const Reach& reach) {
  return fixed(reach.length, 1) + " of " + fixed(reach.of, 1) + " mm";
}

std::string closedText(const ClosedPlaceInfo& place) {
  return "branch " + formats::printable(place.branch) + " is closed before its node " +
         std::to_string(place.node) + ", at (" + fixed(place.position.x, 1) + ", " +
         fixed(place.position.y, 1) + ", " + fixed(place.position.z, 1) +
         "): " + fixed(place.beyond, 1) + " mm beyond cannot be reached";
}

Json reachJson(const std::optional<Reach>& reach) {
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const ClosedPlaceInfo& place : reach->closed)
    closed.push_back({{"branch", place.branch},
                      {"node", place.node},
                      {"position_mm",
                       {jsonNumber(place.position.x), jsonNumber(place.position.y),
                        jsonNumber(place.position.z)}},
                      {"beyond_mm", jsonNumber(place.beyond)}});
  return {{"length_mm", jsonNumber(reach->length)},
          {"of_mm", jsonNumber(reach->of)},
          {"closed", std::move(closed)}};
}

Json withReach(Json json, const std::optional<Reach>& reach) {
  json["reachable"] = reachJson(reach);
  return json;
}

std::string reachLine(const std::optional<Reach>& reach) {
  return reach ? "reachable: " + reachText(*reach) + "\n" : std::string();
}

void warnOfClosed(const std::optional<Reach>& reach, Progress& progress) {
  constexpr std::size_t kMost = 20;
  if (!reach) return;
  for (std::size_t i = 0; i < std::min(reach->closed.size(), kMost); ++i)
    progress.warn(closedText(reach->closed[i]));
  if (reach->closed.size() > kMost)
    progress.warn("and so on at " + std::to_string(reach->closed.size() - kMost) +
                  " more places; lumen info --json lists all");
}

}  // namespace lumen::app
