// SPDX-License-Identifier: Apache-2.0
// Headers of files elsewhere, for `lumen info`.
#pragma once

#include <filesystem>

#include "converters/engine/chunk_info.h"
#include "converters/engine/file_format.h"
#include "converters/engine/remote_inputs.h"
#include "converters/engine/stage_options.h"

namespace lumen::engine {

/// Whether files of this format begin with a table of their chunks.
bool isBinaryCase(const FileFormat& format);

/// The header and the table of chunks of a case, of which no more is fetched. Throws as
/// describeChunkTable() and RemoteInputs::fetchHead().
FileInfo fetchChunkTable(const convert::RemoteAddress& address, RemoteInputs& remote);

/// A file here with the header of a volume, whose voxels are zeros. Faults of the header are left
/// to its reader. Throws as RemoteInputs::fetchHead().
std::filesystem::path fetchVolumeHead(const convert::RemoteAddress& address,
                                      const FileFormat& format, const VolumeArguments& volume,
                                      RemoteInputs& remote);

}  // namespace lumen::engine
