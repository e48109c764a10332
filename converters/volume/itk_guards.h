// SPDX-License-Identifier: Apache-2.0
// What an NRRD or MetaImage header says before ITK's reader repairs it: that reader takes a spacing
// that is no number as 1 or moves its sign into the direction, allocates before it looks at the
// data, and keeps what a damaged deflate stream gives. So the few fields that it hides are read
// twice. Teem, the reference library for NRRD, is no way out: ITK's reader is a copy of it, with
// the same repairs, and MetaImage has no other library in Debian 12.
#pragma once

#include <filesystem>

#include "converters/common/progress.h"

namespace lumen::convert {

/// Throws Error(InvalidInput) for a file whose header is not one of its format, or states a spacing
/// that is not positive and finite, or whose data is shorter than the header says or a damaged
/// deflate stream; Error(Unsupported) for another encoding than raw, gzip, hex and text.
void checkNrrdHeader(const std::filesystem::path& path, const Progress& progress);
void checkMetaHeader(const std::filesystem::path& path, const Progress& progress);

}  // namespace lumen::convert
