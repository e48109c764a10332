// SPDX-License-Identifier: Apache-2.0
// One input of a batch. Private to the sources of this folder.
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "converters/library/batch/batch.h"

namespace lumen::convert {

/// Makes the case of an input, judges it and draws it, as far as an earlier run has not. Any failure
/// is in the result. Throws Error(Cancelled).
BatchResult makeBatchCase(const BatchInput& input, const std::filesystem::path& folder,
                          const BuildOptions& options, Progress& progress);

}  // namespace lumen::convert
