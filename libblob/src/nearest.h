// SPDX-License-Identifier: Apache-2.0
// Samples with an exact distance, and the nearest point of the wall.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model.h"
#include "wall_foot.h"

namespace lumen::blob {

/// blob_query(): the back end's answer, with distance and normal refined if the flags ask for it.
/// The cursor follows.
void sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
              std::uint32_t& node, blob_sample& sample) noexcept;

/// Replaces distance and normal of those of at most kMostRefined points that are in range by those
/// of the nearest point of the wall. The samples are answers of f at the points.
void refineSamples(const blob_model& model, std::uint32_t flags, std::size_t count,
                   const double (*points)[3], const bool* inRange, blob_sample* samples) noexcept;

/// blob_nearest() for a finite point in range of its node, which is not moved.
void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept;

}  // namespace lumen::blob
