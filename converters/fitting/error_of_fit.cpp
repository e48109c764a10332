// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/error_of_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "formats/case/blobby.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

/// The smallest value that at least `share` of the values do not exceed; reorders them.
float percentile(std::vector<float>& values, double share) {
  const auto count = static_cast<double>(values.size());
  const auto rank = static_cast<std::size_t>(std::ceil(share * count - 1e-9));
  const std::size_t index = std::max<std::size_t>(rank, 1) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index),
                   values.end());
  return values[index];
}

float taubinDistance(const formats::BlobbyModels& models, std::uint32_t node,
                     const formats::Vec3f& p) {
  const formats::FieldValue value = formats::evaluateField(models, node, {p.x, p.y, p.z});
  const formats::Vec3d& g = value.gradient;
  const double gradient = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z);
  return gradient > 0 ? static_cast<float>(std::abs(models.isoLevel - value.f) / gradient)
                      : std::numeric_limits<float>::infinity();
}

}  // namespace

std::vector<float> errorOfFit(const formats::Case& value, int neighbourhood, Progress& progress) {
  if (!value.points) throw invalidInput("error of fit: the case has no wall points");
  if (!value.models) throw invalidInput("error of fit: the case has no blobby models");
  const std::size_t count = value.tree.nodeCount();
  const formats::Neighbours neighbours(value.tree);
  const formats::PointSets& points = *value.points;
  std::vector<float> errors(count, std::numeric_limits<float>::quiet_NaN());
  tbb::enumerable_thread_specific<std::vector<float>> buffers;
  progress.begin("error of fit", count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    progress.check();
    const auto node = static_cast<std::uint32_t>(i);
    std::vector<float>& distances = buffers.local();
    distances.clear();
    for (const std::uint32_t near : neighbours.within(node, neighbourhood)) {
      for (std::uint32_t k = points.offset[near]; k < points.offset[near + 1]; ++k) {
        distances.push_back(taubinDistance(*value.models, node, points.position[k]));
      }
    }
    if (!distances.empty()) errors[i] = percentile(distances, 0.9);
    progress.advance();
  });
  progress.end();
  return errors;
}

ErrorOfFitSummary summariseErrorOfFit(std::vector<float> errors) {
  std::erase_if(errors, [](float e) { return std::isnan(e); });
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (errors.empty()) return {kNone, kNone, kNone};
  return {percentile(errors, 0.5), percentile(errors, 0.9), percentile(errors, 1.0)};
}

}  // namespace lumen::convert
