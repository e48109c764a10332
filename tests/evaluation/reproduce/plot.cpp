// SPDX-License-Identifier: Apache-2.0
#include "plot.h"

#include <nlohmann/json.hpp>

#include "report.h"

namespace lumen::reproduce {

std::string plotJson(const Plot& plot) {
  using Json = nlohmann::ordered_json;
  Json root{{"title", plot.title},
            {"x", plot.xLabel},
            {"y", plot.yLabel},
            {"logarithmic", plot.logarithmic},
            {"curves", Json::array()}};
  for (const Curve& curve : plot.curves) {
    Json points = Json::array();
    for (const auto& [x, y] : curve.points) points.push_back(Json::array({x, y}));
    root["curves"].push_back({{"name", curve.name}, {"dashed", curve.dashed}, {"points", points}});
  }
  return root.dump() + "\n";
}

void writePlot(const std::filesystem::path& folder, const std::string& name, const Plot& plot) {
  writeText(folder / (name + ".plot.json"), plotJson(plot));
}

}  // namespace lumen::reproduce
