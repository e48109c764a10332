// SPDX-License-Identifier: Apache-2.0
// Centerlines as curves of 3D Slicer's Markups (`.mrk.json`), in.
#pragma once

#include <filesystem>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// The curves of a file, or of all `.mrk.json` of a folder in the order of their names, as one tree
/// (join_curves.h). A curve's points need radii, in its measurement "Radius". Lengths are mm, axes
/// LPS, whatever the file has. Markups that are no curves of two points at least are left out with a
/// remark. Throws Error(InvalidInput) with the file's name, what was found and what was expected.
CenterlineFile readCurves(const std::filesystem::path& fileOrFolder);

/// Whether a folder has a file that readCurves() would read.
bool hasCurves(const std::filesystem::path& folder);

}  // namespace lumen::convert
