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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of the level: fields below it say nothing about where the wall is.
constexpr double kVanished = 1e-12;

/// The smallest value that at least `share` of the values do not exceed; reorders them.
float percentile(std::vector<float>& values, double share) {
  const auto count = static_cast<double>(values.size());
  const auto rank = static_cast<std::size_t>(std::ceil(share * count - 1e-9));
  const std::size_t index = std::max<std::size_t>(rank, 1) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index),
                   values.end());
  return values[index];
}

/// What there is to say about one point: f, |grad f|, and how far the node is.
struct At {
  double f = 0, slope = 0, toNode = 0;
};

struct Straight {
  double h = 0, slope = 0;
};

/// A function of f that grows nearly with the square of the distance from the axis; f > 0.
Straight straighten(formats::Kernel kernel, double f, double slope) {
  switch (kernel) {
    case formats::Kernel::Cauchy:
      return {1.0 / std::sqrt(f), 0.5 * slope / (f * std::sqrt(f))};
    case formats::Kernel::Gaussian:
      return {-formats::repeatableLog(f), slope / f};
    case formats::Kernel::Quartic:
    case formats::Kernel::SoftObject:
      break;
  }
  return {-std::sqrt(f), 0.5 * slope / std::sqrt(f)};
}

/// |grad h| / (2 c) - R of the design notes, without its cancellation.
double wallDistance(formats::Kernel kernel, double level, const At& at, double radius) {
  const double farSide = at.toNode + radius;
  if (!(at.f > kVanished * level)) return farSide;
  const Straight here = straighten(kernel, at.f, at.slope);
  const double d = std::abs(straighten(kernel, level, 0).h - here.h), gr = here.slope * radius;
  const double s = std::sqrt(d * d + gr * gr), t = gr + s;
  if (!(d > 0)) return 0;
  if (at.f > level) return radius * d * (t + d) / (t * (d + s));
  return std::min(radius * d * (t + d) / (t * gr), farSide);
}

double distanceTo(const formats::Case& value, std::uint32_t node, const formats::Vec3f& p,
                  FitDistance measure) {
  const formats::BlobbyModels& models = *value.models;
  if (models.offset[node] == models.offset[node + 1]) return kInfinity;
  const auto norm = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
  const formats::FieldValue field = formats::evaluateField(models, node, {p.x, p.y, p.z});
  const formats::Vec3f& c = value.tree.centre[node];
  const formats::Vec3d& g = field.gradient;
  const At at{field.f, norm(g.x, g.y, g.z),
              norm(double{p.x} - c.x, double{p.y} - c.y, double{p.z} - c.z)};
  if (measure == FitDistance::Wall) {
    return wallDistance(models.kernel, models.isoLevel, at, value.tree.radius[node]);
  }
  return at.slope > 0 ? std::abs(models.isoLevel - at.f) / at.slope : kInfinity;
}

}  // namespace

std::vector<float> errorOfFit(const formats::Case& value, int neighbourhood, Progress& progress,
                              FitDistance measure) {
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
        distances.push_back(
            static_cast<float>(distanceTo(value, node, points.position[k], measure)));
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
