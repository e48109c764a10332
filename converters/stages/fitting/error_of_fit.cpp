// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/error_of_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "formats/case/blobby.h"
#include "formats/case/topology.h"
#include "formats/field/kernel.h"

namespace lumen::convert {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Least field, as a share of the level: smaller ones do not locate the wall.
constexpr double kVanished = 1e-12;
/// Share of a node's points whose distances its error of fit bounds (Yureidini's thesis, 4.8.4).
constexpr double kShareOfPoints = 0.9;

/// The values at one point: f, |grad f|, and its distance from the node.
struct At {
  double f = 0, slope = 0, toNode = 0;
};

/// |grad h| / (2 c) - R of docs/method.md, section 4.2, without its cancellation. libblob has it on
/// lanes of floats (simd/wall_distance.h), signed, and answers with the ball where f vanishes.
double wallDistance(formats::Kernel kernel, double level, const At& at, double radius) {
  const double farSide = at.toNode + radius;
  if (!(at.f > kVanished * level)) return farSide;
  const field::LevelTransform here = field::levelTransform(kernel, at.f, at.slope);
  const double d = std::abs(field::levelTransform(kernel, level).h - here.h);
  const double gr = here.slope * radius;
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
    if (!distances.empty()) errors[i] = nearestRank(distances, kShareOfPoints);
    progress.advance();
  });
  progress.end();
  return errors;
}

ErrorOfFitSummary summariseErrorOfFit(std::vector<float> errors) {
  std::erase_if(errors, [](float e) { return std::isnan(e); });
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (errors.empty()) return {kNone, kNone, kNone};
  return {nearestRank(errors, 0.5), nearestRank(errors, 0.9), nearestRank(errors, 1.0)};
}

int fittedNeighbourhood(const formats::Metadata& metadata) {
  for (auto step = metadata.steps.rbegin(); step != metadata.steps.rend(); ++step) {
    if (step->name != "fit") continue;
    const auto found = step->parameters.find("neighbourhood");
    if (found == step->parameters.end()) break;
    if (const auto* value = std::get_if<std::int64_t>(&found->second))
      return static_cast<int>(std::clamp<std::int64_t>(*value, 0, 100));
  }
  return 2;
}

std::optional<ErrorOfFitSummary> fittedError(const formats::Case& value, Progress& progress) {
  if (!value.points || !value.models) return std::nullopt;
  const auto summary =
      summariseErrorOfFit(errorOfFit(value, fittedNeighbourhood(value.metadata), progress));
  if (std::isnan(summary.median)) return std::nullopt;
  return summary;
}

}  // namespace lumen::convert
