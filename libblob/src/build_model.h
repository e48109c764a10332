// SPDX-License-Identifier: Apache-2.0
// A model from a checked definition.
#pragma once

#include <memory>

#include "model.h"

namespace lumen::blob {

/// Builds a model from a checked definition. Throws std::bad_alloc and nothing else.
std::unique_ptr<blob_model> buildModel(const blob_model_def& def);

/// Memory of a model in bytes.
std::size_t countBytes(const blob_model& model) noexcept;

}  // namespace lumen::blob
