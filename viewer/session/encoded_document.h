// SPDX-License-Identifier: Apache-2.0
// The document as a file to download.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "converters/base/progress.h"
#include "viewer/session/document.h"
#include "viewer/session/dropped_files.h"
#include "viewer/session/session_options.h"

namespace lumen::viewer {

/// Pairs of an option's name without hyphens, and its value.
using SavingOptions = std::vector<std::pair<std::string, std::string>>;

/// The case, its mesh, its centerline or the seeds in that format, as `lumen convert` with these
/// options writes it; a case without models is fitted for a mesh. `places` has the temporary file.
/// Throws Error(Usage) for an unknown format or option, and as the writers.
std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    DroppedFiles& places, Progress& progress);

}  // namespace lumen::viewer
