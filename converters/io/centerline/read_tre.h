// SPDX-License-Identifier: Apache-2.0
// Reader of TubeTK's tubes (`.tre`): a scene of ITK's MetaIO, text or binary.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// The tubes of a scene as one tree: each is attached to its parent where ParentID names a tube,
/// else to the tube in which it begins (join_curves.h). Spacing, matrix and offset of the objects
/// are applied as ITK does, so lengths are mm and the axes LPS. Other objects of the scene are left
/// out with a remark. Throws Error(InvalidInput) with `name`, the line, the finding and the
/// expectation.
CenterlineFile parseTre(std::string_view text, const std::string& name);

/// Reads a file of at most 64 MiB as parseTre() does.
CenterlineFile readTre(const std::filesystem::path& file);

}  // namespace lumen::convert
