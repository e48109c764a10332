// SPDX-License-Identifier: Apache-2.0
// Line plots as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lumen::reproduce {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool dashed = false;
};

struct Plot {
  std::string title, xLabel, yLabel;
  bool logarithmic = false;  ///< the y axis; values that are not above zero are left out
  std::vector<Curve> curves;
};

std::string svg(const Plot& plot);

}  // namespace lumen::reproduce
