// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/reachable_answer.h"

#include <utility>

namespace lumen::engine {

Json reachJson(const std::optional<convert::Reach>& reach) {
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const convert::ClosedPath& path : reach->closed)
    closed.push_back(
        {{"branch", path.branch},
         {"node", path.node},
         {"position",
          {jsonNumber(path.position.x), jsonNumber(path.position.y), jsonNumber(path.position.z)}},
         {"beyond_mm", jsonNumber(path.beyond)}});
  return {{"length_mm", jsonNumber(reach->length)},
          {"of_mm", jsonNumber(reach->of)},
          {"trees", reach->trees},
          {"longest_tree_mm", jsonNumber(reach->longest)},
          {"closed", std::move(closed)}};
}

}  // namespace lumen::engine
