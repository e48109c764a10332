// SPDX-License-Identifier: Apache-2.0
// Volumes in which vessels cannot be tracked, or hardly, whatever the seeds are.
#pragma once

#include <optional>
#include <string>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// What is doubtful about the voxels of a volume that vessels are to be tracked in, as a sentence
/// without the file's name: that they have two values only, as a mask has. Throws
/// Error(InvalidInput), likewise, if all are equal.
std::optional<std::string> doubtAbout(const Volume& volume);

}  // namespace lumen::convert
