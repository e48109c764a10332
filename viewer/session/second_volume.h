// SPDX-License-Identifier: Apache-2.0
// A second volume beside the first: whether both can be of one patient, as far as files show it.
#pragma once

#include <optional>
#include <string>

#include "converters/voxels/volume.h"
#include "viewer/session/document.h"

namespace lumen::viewer {

/// Share of the second volume that lies in the first, or of the first in the second: the greater,
/// in [0, 1]. Both are sampled at places that are spread evenly over them.
double sharedPart(const convert::VolumeGeometry& first, const convert::VolumeGeometry& second);

/// A sentence on what speaks against both volumes being seen at one place: they do not overlap or
/// hardly do, they have the same voxels at other places, or the open case was made from the second
/// and not from the first. None without a second volume and where nothing does. No file states that
/// two volumes are of one patient, so no answer does not state it either.
std::optional<std::string> secondDoubt(const Document& document);

}  // namespace lumen::viewer
