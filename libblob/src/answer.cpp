// SPDX-License-Identifier: Apache-2.0
#include "answer.h"

#include <limits>

namespace lumen::blob {

void answerOutOfRange(const blob_model& model, const double* point, std::uint32_t node,
                      blob_sample& sample) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const bool isNan = std::isnan(point[0]) || std::isnan(point[1]) || std::isnan(point[2]);
  sample = {};
  sample.node = node;
  sample.value = isNan ? kNan : 0.0;
  sample.distance = isNan ? kNan : kInfinity;
  for (int i = 0; i < 3; ++i) sample.gradient[i] = sample.normal[i] = sample.value;
  if (!isFinitePoint(point)) return;
  const NodeRecord& record = model.nodes[node];
  double fromCentre[3];
  for (int i = 0; i < 3; ++i) fromCentre[i] = point[i] - record.centre[i];
  const double length = std::hypot(fromCentre[0], fromCentre[1], fromCentre[2]);
  sample.distance = length - double{record.radius()};
  if (!(length < kInfinity)) return;
  for (int i = 0; i < 3; ++i) sample.normal[i] = fromCentre[i] / length;
}

}  // namespace lumen::blob
