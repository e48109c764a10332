// SPDX-License-Identifier: Apache-2.0
// SWC: points of trees as text (Cannon, Turner, Pyapali and Wheal, "An on-line archive of
// reconstructed hippocampal neurons", 1998).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// Reads an SWC file of at most 64 MiB. A line is a point: id, type, x, y, z, radius, and the id of
/// its parent or -1, with blanks or tabs in between; lines end with LF, CR LF or CR. Text after #,
/// and columns beyond the seventh (as Vaa3D's), are ignored. Ids may have gaps, any order and any
/// start, and may be written as 1.0; a parent may follow its children; there may be several roots.
/// Points keep the file's order as far as parents come first. Radii of 0 or less are placeholders,
/// and filled in (fill_radii.h); NeuroMorpho's files are in micrometres, and their soma of three
/// points is one; comments of lumen's own files name vessels. Throws Error(InvalidInput) with the
/// line, the finding and the expectation: for malformed or non-finite numbers, trees without any
/// radius, ids that occur twice, missing parents, and cycles.
CenterlineFile readSwc(const std::filesystem::path& file);

/// Reads a text as readSwc() does; `name` is the name of its file, for messages.
CenterlineFile parseSwc(std::string_view text, const std::string& name);

}  // namespace lumen::convert
