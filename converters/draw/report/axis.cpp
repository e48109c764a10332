// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/axis.h"

#include <algorithm>
#include <cmath>

namespace lumen::convert {

Axis axisTo(double end, int most) {
  Axis axis;
  axis.end = std::isfinite(end) && end > 0 ? end : 1;
  const double least = axis.end / std::max(1, most);
  int power = static_cast<int>(std::floor(std::log10(least)));
  double step = 0;
  // the next power of ten is at least `least`, so one of these is found
  for (const double times : {1.0, 2.0, 5.0, 10.0}) {
    step = times * std::pow(10.0, power);
    if (step * (1 + 1e-12) >= least) {
      if (times == 10) ++power;
      break;
    }
  }
  axis.digits = std::max(0, -power);
  for (int i = 0; i * step <= axis.end * (1 + 1e-12); ++i) axis.marks.push_back(i * step);
  return axis;
}

}  // namespace lumen::convert
