// SPDX-License-Identifier: Apache-2.0
// The functions that exist once for each set of SIMD instructions. All give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model.h"
#include "posed_model.h"
#include "wall_foot.h"

namespace lumen::blob {

/// A batch of queries. Answers go to `samples`, or to the columns if that is null.
struct Job {
  blob_columns columns;
  blob_sample* samples;
  bool* inRange;  ///< null, or whether each sample is an answer of f; with samples only
};

/// Derivatives of f, all times one positive factor: the gradient, and the Hessian as xx, yy, zz, xy,
/// xz, yz.
struct Shape {
  float gradient[3], hessian[6];
};

/// Functions of a back end. None of them evaluates BLOB_DISTANCE_EXACT: sampleAt() in nearest.h
/// does.
struct Backend {
  /// The node of least power. The point is finite.
  std::uint32_t (*locate)(const blob_model&, const double* point);
  /// The node that the cursor at `node` moves to. The point is finite.
  std::uint32_t (*follow)(const blob_model&, const double* point, std::uint32_t node);
  /// Whether f > T at a finite point in range of `node`; the cursor has followed.
  bool (*inside)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t node);
  /// Bounds on f in the ball of `radius` mm around a point; radius at most half of the node's.
  void (*bounds)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t node,
                 float radius, float* least, float* greatest);
  /// Answers at any point, with the bits of `query`. False if the point is out of range; `sample`
  /// is valid even then.
  bool (*queryOne)(const blob_model&, std::uint32_t flags, const double* point, std::uint32_t& node,
                   blob_sample& sample);
  /// Answers at any points.
  void (*query)(const blob_model&, std::uint32_t flags, const Job&);
  /// Writes the blobs, centres and radii of posed nodes.
  void (*placeBlobs)(blob_pose&, const std::uint32_t* nodes, std::size_t count);
  /// Writes the neighbours of nodes, whose centres, radii and spacings are those of the pose.
  void (*placeNeighbours)(blob_pose&, const std::uint32_t* nodes, std::size_t count);
  /// The greatest strain of edges, which are indices into pose.edgeReference.
  float (*greatestStrain)(const blob_pose&, const std::uint32_t* edges, std::size_t count);
  /// The nearest points of the wall.
  void (*findFeet)(const blob_model&, std::uint32_t flags, const FootJob&);
};

/// A back end; null where the build lacks it.
const Backend* scalarBackend(blob_kernel kernel) noexcept;
const Backend* portableBackend(blob_kernel kernel) noexcept;
const Backend* avx2Backend(blob_kernel kernel) noexcept;
const Backend* avx512Backend(blob_kernel kernel) noexcept;

/// The wanted back end, or the next below that this build and processor have; `wanted` is set to
/// the chosen one.
const Backend* chooseBackend(blob_kernel kernel, blob_simd& wanted) noexcept;

}  // namespace lumen::blob
