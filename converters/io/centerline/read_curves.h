// SPDX-License-Identifier: Apache-2.0
// Reader of centerlines as curves of 3D Slicer's Markups (`.mrk.json`).
#pragma once

#include <filesystem>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// The curves of a file, or of all `.mrk.json` of a folder in the order of their names, as one tree
/// (join_curves.h). A curve's points need radii, in its measurement "Radius". Lengths are converted
/// to mm, axes to LPS. Markups other than curves of at least two points are left out with a remark.
/// Throws Error(InvalidInput) with the file's name, the finding and the expectation.
CenterlineFile readCurves(const std::filesystem::path& fileOrFolder);

/// Whether a folder has a file that readCurves() would read.
bool hasCurves(const std::filesystem::path& folder);

}  // namespace lumen::convert
