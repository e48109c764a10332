// SPDX-License-Identifier: Apache-2.0
// A model from a definition.
#pragma once

#include <memory>

#include "blob.h"
#include "model.h"

namespace lumen::blob {

/// Checks everything that queries rely on: counts, ranges, indices, finite numbers.
blob_status checkDefinition(const blob_model_def& def) noexcept;

/// Builds a model from a checked definition. Throws std::bad_alloc and nothing else.
std::unique_ptr<blob_model> buildModel(const blob_model_def& def);

/// A radius, mm: where a sum of `count` blobs is more than T, one of them is nearer than this, as one
/// exceeds T / count. `width`: mm, and `scale`: factor of |X - C|^2, of the blob.
double reachOfBlob(const Field& field, double width, double scale, double count) noexcept;

/// Memory of a model in bytes.
std::size_t countBytes(const blob_model& model) noexcept;

}  // namespace lumen::blob
