// SPDX-License-Identifier: Apache-2.0
// The data of line plots, which plots.py draws.
#pragma once

#include <filesystem>
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

/// {"title", "x", "y", "logarithmic", "curves": [{"name", "dashed", "points": [[x, y], ...]},
/// ...]}; a coordinate that is not finite is null.
std::string plotJson(const Plot& plot);

/// Writes `name`.plot.json, of which plots.py makes `name`.svg. Throws Error(Failed).
void writePlot(const std::filesystem::path& folder, const std::string& name, const Plot& plot);

}  // namespace lumen::reproduce
