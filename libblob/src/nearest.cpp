// SPDX-License-Identifier: Apache-2.0
#include "nearest.h"

#include <optional>

#include "columns.h"
#include "newton_projection.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

void refineBy(const blob_nearest_point& nearest, blob_sample& sample) {
  sample.distance = nearest.distance;
  for (int i = 0; i < 3; ++i) sample.normal[i] = nearest.normal[i];
  if (nearest.converged == 0) sample.state |= BLOB_NOT_CONVERGED;
}

}  // namespace

void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept {
  NewtonProjection(model, flags, point, node, tolerance, maxSteps).run(nullptr, nearest);
}

void sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
              std::uint32_t& node, blob_sample& sample) noexcept {
  const bool inRange = model.backend->queryOne(model, flags, point, node, sample);
  if ((flags & BLOB_DISTANCE_EXACT) != 0 && inRange) refineSample(model, flags, point, sample);
}

void refineSample(const blob_model& model, std::uint32_t flags, const double* point,
                  blob_sample& sample) noexcept {
  NewtonProjection search(model, flags, point, sample.node, 0, 0);
  blob_nearest_point nearest;
  search.run(&sample, nearest);
  refineBy(nearest, sample);
}

void refineSamples(const blob_model& model, std::uint32_t flags, std::size_t count,
                   const double (*points)[3], const bool* inRange, blob_sample* samples) noexcept {
  std::optional<NewtonProjection> search[kMostRefined];
  std::size_t waiting[kMostRefined], left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!inRange[i]) continue;
    search[i].emplace(model, flags, points[i], samples[i].node, 0.0, 0U);
    search[i]->begin(&samples[i]);
    if (search[i]->isWaiting()) waiting[left++] = i;
  }
  double at[kMostRefined][3];
  std::uint32_t node[kMostRefined];
  blob_sample there[kMostRefined];
  while (left > 0) {
    for (std::size_t k = 0; k < left; ++k) {
      const Vec& place = search[waiting[k]]->place();
      at[k][0] = place.x;
      at[k][1] = place.y;
      at[k][2] = place.z;
      node[k] = search[waiting[k]]->node();
    }
    model.backend->query(model, flags, Job{packedColumns(left, at, node), there, nullptr});
    std::size_t still = 0;
    for (std::size_t k = 0; k < left; ++k) {
      NewtonProjection& each = *search[waiting[k]];
      each.resume(there[k]);
      if (each.isWaiting()) waiting[still++] = waiting[k];
    }
    left = still;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!inRange[i]) continue;
    blob_nearest_point nearest;
    search[i]->finish(nearest);
    refineBy(nearest, samples[i]);
  }
}

}  // namespace lumen::blob
