// SPDX-License-Identifier: Apache-2.0
// The functions that exist once for each set of SIMD instructions. All give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model.h"

namespace lumen::blob {

/// Answers go to `samples`, or to the columns if that is null.
struct Job {
  blob_columns columns;
  blob_sample* samples;
  bool* inRange;  ///< null, or which of the samples are answers of f; with samples only
};

/// None of these looks at BLOB_DISTANCE_EXACT: sampleAt() in nearest.h does.
struct Backend {
  /// The node of least power. The point is finite.
  std::uint32_t (*locate)(const blob_model&, const double* point);
  /// The node that the cursor at `node` moves to. The point is finite.
  std::uint32_t (*follow)(const blob_model&, const double* point, std::uint32_t node);
  /// f > T at a finite point in range of `node`; the cursor has followed.
  bool (*inside)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t node);
  /// Bounds on f in the ball of `radius` mm around a point; radius at most half of the node's.
  void (*bounds)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t node,
                 float radius, float* least, float* greatest);
  /// Any point; the bits of `query`. False if the point is out of range, which is an answer too.
  bool (*queryOne)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t& node,
                   blob_sample& sample);
  /// Any points.
  void (*query)(const blob_model&, std::uint32_t flags, const Job&);
};

/// Null where the build has no such back end.
const Backend* scalarBackend(blob_kernel kernel) noexcept;
const Backend* portableBackend(blob_kernel kernel) noexcept;
const Backend* avx2Backend(blob_kernel kernel) noexcept;
const Backend* avx512Backend(blob_kernel kernel) noexcept;

/// The wanted back end, or the next below that this build and processor have; `wanted` is set to
/// it.
const Backend* chooseBackend(blob_kernel kernel, blob_simd& wanted) noexcept;

}  // namespace lumen::blob
