// SPDX-License-Identifier: Apache-2.0
// From a checked definition to a model.
#pragma once

#include <memory>

#include "model.h"

namespace lumen::blob {

/// Throws std::bad_alloc and nothing else. The definition has been checked.
std::unique_ptr<blob_model> buildModel(const blob_model_def& def);

/// Bytes.
std::size_t memoryOf(const blob_model& model) noexcept;

}  // namespace lumen::blob
