// SPDX-License-Identifier: Apache-2.0
// Reader of centerlines of VMTK and others as lines of VTK (`.vtp`).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// The lines of a file as one tree (join_curves.h): lines from a root to every tip share their
/// trunk, by their points or their course; tracts cut by vmtkbranchextractor (CenterlineIds,
/// TractIds) are joined first. Radii are those of MaximumInscribedSphereRadius, or Radius; without
/// either all are 0. The file states no unit and no axes, except in a comment of lumen's own files.
/// Throws Error(InvalidInput) with `name`, the finding and the expectation.
CenterlineFile parseVtpCenterline(std::string_view text, const std::string& name);

/// Reads a file of at most 64 MiB as parseVtpCenterline() does.
CenterlineFile readVtpCenterline(const std::filesystem::path& file);

}  // namespace lumen::convert
