// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/reachable_answer.h"

#include <utility>

namespace lumen::engine {

Json reachJson(const std::optional<convert::Reach>& reach) {
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const convert::ClosedWay& way : reach->closed)
    closed.push_back(
        {{"branch", way.branch},
         {"node", way.node},
         {"position",
          {jsonNumber(way.position.x), jsonNumber(way.position.y), jsonNumber(way.position.z)}},
         {"beyond_mm", jsonNumber(way.beyond)}});
  return {{"length_mm", jsonNumber(reach->length)},
          {"of_mm", jsonNumber(reach->of)},
          {"closed", std::move(closed)}};
}

}  // namespace lumen::engine
