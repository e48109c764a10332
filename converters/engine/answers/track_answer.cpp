// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/track_answer.h"

#include <algorithm>
#include <vector>

#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "formats/case/enum_names.h"
#include "formats/container/printable.h"

namespace lumen::engine {
namespace {

Json seedRemarks(const std::vector<convert::SeedFailure>& failures) {
  Json remarks = Json::array();
  for (const auto& failure : failures)
    remarks.push_back({{"label", failure.label}, {"reason", failure.reason}});
  return remarks;
}

Json endJson(const convert::TrackEnd& end) {
  const Eigen::Vector3d& p = end.position;
  return {{"branch", end.label},
          {"end", end.isStart ? "start" : "tip"},
          {"reason", formats::enumName(formats::kStopReasonNames, end.reason)},
          {"position", {jsonNumber(p.x()), jsonNumber(p.y()), jsonNumber(p.z())}},
          {"goes_on_mm", jsonNumber(end.goesOn)}};
}

std::string endLine(const convert::TrackEnd& end) {
  return "the " + std::string(end.isStart ? "start" : "tip") + " of " +
         formats::printable(end.label) + " at " + convert::placeText(end.position) +
         ": a lumen leads on for at least " + fixedText(end.goesOn, 1) +
         " mm, which no cylinder fits\n";
}

}  // namespace

Json repetitionJson(const std::optional<convert::Repetition>& repetition,
                    const formats::Case& value) {
  if (!repetition) return nullptr;
  Json vessels = Json::array(), unstable = Json::array();
  for (std::size_t b = 0; b < repetition->branches.size(); ++b)
    vessels.push_back({{"branch", value.tree.branches[b].label},
                       {"found_again", jsonNumber(static_cast<double>(repetition->branches[b]))}});
  for (const convert::Repetition::Vessel& vessel : repetition->unstable)
    unstable.push_back({{"branch", vessel.label.empty() ? Json(nullptr) : Json(vessel.label)},
                        {"length_mm", jsonNumber(vessel.length)},
                        {"runs", vessel.runs}});
  return {{"runs", repetition->runs},
          {"least_length_mm", jsonNumber(repetition->leastLength)},
          {"greatest_length_mm", jsonNumber(repetition->greatestLength)},
          {"spread_share", jsonNumber(repetition->spread())},
          {"branches", std::move(vessels)},
          {"unstable", std::move(unstable)}};
}

std::string repetitionLines(const std::optional<convert::Repetition>& repetition) {
  if (!repetition) return {};
  std::string text = "repeated     " + std::to_string(repetition->runs) +
                     " times: " + fixedText(repetition->leastLength, 1) + " to " +
                     fixedText(repetition->greatestLength, 1) + " mm, a spread of " +
                     fixedText(100 * repetition->spread(), 1) + " %\n";
  constexpr std::size_t kMostShown = 10;
  const auto& unstable = repetition->unstable;
  for (std::size_t i = 0; i < std::min(unstable.size(), kMostShown); ++i)
    text += unstable[i].label.empty()
                ? "unstable     a run has another vessel of " + fixedText(unstable[i].length, 1) +
                      " mm\n"
                : "unstable     " + formats::printable(unstable[i].label) + ", " +
                      fixedText(unstable[i].length, 1) + " mm, is lacked by " +
                      counted(unstable[i].runs, "run", "runs") + "\n";
  if (unstable.size() > kMostShown)
    text += "and so on for " + std::to_string(unstable.size() - kMostShown) + " more vessels; " +
            kOption.json.shown() + " lists all\n";
  return text;
}

Json withRemarks(Json json, const convert::TrackRemarks& remarks) {
  json["failed_seeds"] = seedRemarks(remarks.failures);
  json["missed_points"] = seedRemarks(remarks.missedPoints);
  json["unjoined"] = seedRemarks(remarks.unjoined);
  json["ends"] = Json::array();
  for (const convert::TrackEnd& end : remarks.ends) json["ends"].push_back(endJson(end));
  return json;
}

std::string endLines(const convert::TrackRemarks& remarks) {
  constexpr std::size_t kMostEndLines = 10;
  std::vector<convert::TrackEnd> open = remarks.ends;
  std::erase_if(open, [](const convert::TrackEnd& end) { return end.goesOn <= 0; });
  std::stable_sort(open.begin(), open.end(),
                   [](const auto& a, const auto& b) { return a.goesOn > b.goesOn; });
  std::string text;
  for (std::size_t i = 0; i < std::min(open.size(), kMostEndLines); ++i) text += endLine(open[i]);
  if (open.size() > kMostEndLines)
    text += "and so on at " + std::to_string(open.size() - kMostEndLines) + " more ends; " +
            kOption.json.shown() + " lists all\n";
  return text;
}

}  // namespace lumen::engine
