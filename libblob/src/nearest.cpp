// SPDX-License-Identifier: Apache-2.0
#include "nearest.h"

#include <cmath>

#include "newton_projection.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

void refineBy(const blob_nearest_point& nearest, blob_sample& sample) {
  sample.distance = nearest.distance;
  for (int i = 0; i < 3; ++i) sample.normal[i] = nearest.normal[i];
  if (nearest.converged == 0) sample.state |= BLOB_NOT_CONVERGED;
}

void reportFoot(const double* point, const blob_sample& first, const WallFoot& foot,
                blob_nearest_point& nearest) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    nearest.point[i] = foot.at[i];
    nearest.normal[i] = foot.normal[i];
    const double way = point[i] - foot.at[i];
    square += way * way;
  }
  const double length = std::sqrt(square);
  nearest.distance = (first.state & BLOB_INSIDE) != 0 ? -length : length;
  nearest.node = foot.node;
  nearest.steps = foot.steps;
  nearest.converged = 1;
}

// The answer to a search of a back end, which goes on in doubles if it has ended early.
void finishSearch(const blob_model& model, std::uint32_t flags, const double* point,
                  const blob_sample& first, const WallFoot& foot, blob_nearest_point& nearest) {
  if (foot.state == FootState::Found) return reportFoot(point, first, foot, nearest);
  NewtonProjection search(model, flags, point, first.node, 0, 0);
  if (foot.state == FootState::None)
    search.run(first, nearest);
  else
    search.run(first, foot, nearest);
}

}  // namespace

void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept {
  blob_sample first;
  model.backend->queryOne(model, flags, point, node, first);
  NewtonProjection search(model, flags, point, node, tolerance, maxSteps);
  if (maxSteps > 0 && maxSteps < NewtonProjection::kUsualSteps) return search.run(first, nearest);
  WallFoot foot;
  const bool inRange = true;
  const double at[1][3] = {{point[0], point[1], point[2]}};
  model.backend->findFeet(model, flags, FootJob{1, at, &inRange, &first, &foot});
  const bool isPlain = !(tolerance > 0) && maxSteps == 0;
  if (isPlain || foot.state == FootState::None)
    finishSearch(model, flags, point, first, foot, nearest);
  else
    search.run(first, foot, nearest);
}

void sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
              std::uint32_t& node, blob_sample& sample) noexcept {
  const bool inRange = model.backend->queryOne(model, flags, point, node, sample);
  if ((flags & BLOB_DISTANCE_EXACT) == 0 || !inRange) return;
  const double at[1][3] = {{point[0], point[1], point[2]}};
  refineSamples(model, flags, 1, at, &inRange, &sample);
}

void refineSamples(const blob_model& model, std::uint32_t flags, std::size_t count,
                   const double (*points)[3], const bool* inRange, blob_sample* samples) noexcept {
  WallFoot feet[kMostRefined];
  model.backend->findFeet(model, flags, FootJob{count, points, inRange, samples, feet});
  for (std::size_t i = 0; i < count; ++i) {
    if (!inRange[i]) continue;
    blob_nearest_point nearest;
    finishSearch(model, flags, points[i], samples[i], feet[i], nearest);
    refineBy(nearest, samples[i]);
  }
}

}  // namespace lumen::blob
