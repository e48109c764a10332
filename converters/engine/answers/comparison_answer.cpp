// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/comparison_answer.h"

#include <optional>
#include <utility>

namespace lumen::engine {

namespace {

void addScore(Json& json, const convert::CenterlineScore& score,
              const std::optional<convert::Quantiles>& wall) {
  json["overlap"] = jsonNumber(score.overlap);
  json["overlap_until_first_error"] = jsonNumber(score.overlapUntilFirstError);
  json["average_inside_mm"] = jsonNumber(score.averageInside);
  json["assd_mm"] = jsonNumber(score.assd);
  json["assd_limited_mm"] = jsonNumber(score.assdLimited);
  json["radius_bias_mm"] = jsonNumber(score.radiusBias);
  json["radius_rms_mm"] = jsonNumber(score.radiusRms);
  json["missed_mm"] = jsonNumber(score.missed);
  json["false_mm"] = jsonNumber(score.falseLength);
  if (wall)
    json["wall_distance_mm"] = {{"median", jsonNumber(wall->median)},
                                {"p90", jsonNumber(wall->p90)},
                                {"max", jsonNumber(wall->max)}};
  else
    json["wall_distance_mm"] = nullptr;
}

}  // namespace

Json comparisonJson(const convert::Comparison& comparison) {
  Json json;
  addScore(json, comparison.score, comparison.wallDistance);
  json["branches"] = Json::array();
  for (const auto& branch : comparison.branches) {
    Json entry;
    entry["label"] = branch.label;
    addScore(entry, branch.score, branch.wallDistance);
    json["branches"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace lumen::engine
