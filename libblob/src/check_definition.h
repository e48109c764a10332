// SPDX-License-Identifier: Apache-2.0
// Conditions that a definition has to fulfil.
#pragma once

#include "blob.h"

namespace lumen::blob {

/// Checks everything that queries rely on: counts, ranges, indices, finite numbers.
blob_status checkDefinition(const blob_model_def& def) noexcept;

}  // namespace lumen::blob
