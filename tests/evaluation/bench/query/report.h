// SPDX-License-Identifier: Apache-2.0
// Measurements of query_bench, as tables and a picture.
#pragma once

#include <string>
#include <vector>

namespace lumen::bench {

struct MethodFigures {
  std::string surface, method;
  double nanoseconds = 0;                 ///< per query
  double medianError = 0, highError = 0;  ///< of the distance, against EXACT; 99th percentile, mm
  double megabytes = 0;
};
std::string markdown(const std::vector<MethodFigures>& rows);
std::string json(const std::vector<MethodFigures>& rows);
std::string svg(const std::vector<MethodFigures>& rows);

}  // namespace lumen::bench
