// SPDX-License-Identifier: Apache-2.0
// A look at files that options name, before any work: it finds a missing one, one of another kind, and a
// table that cannot be read.
#pragma once

#include <string>

#include "converters/base/options/option_table.h"
#include "converters/engine/file_format.h"

namespace lumen::engine {

/// The format of `file`, which must be a volume. `role` and `expected`, as messages name it: "label map" and
/// "volume of labels". Throws Error(InvalidInput) for a file that is missing, may not be read or is no
/// volume, Error(Unsupported) for a name of no format.
const FileFormat& volumeFormat(const InputFile& file, const std::string& role,
                               const std::string& expected);

/// Looks at the files that a row names as inputs, without options of reading: tables, cases and
/// centerlines are read, the headers of volumes are, files of other options must be there. Throws as
/// their readers.
void lookAtFiles(const OptionRow& row);

}  // namespace lumen::engine
