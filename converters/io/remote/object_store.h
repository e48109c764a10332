// SPDX-License-Identifier: Apache-2.0
// Files of object stores (s3://BUCKET/KEY), which rclone or aws fetch with the credentials that
// they know. Private to the sources of this folder.
#pragma once

#include <cstdint>
#include <filesystem>

#include "converters/io/remote/remote_file.h"

namespace lumen::convert {

/// Writes the object to the new file `output`. Throws as fetchFile().
void fetchObject(const RemoteAddress& address, const std::filesystem::path& output,
                 const RemoteOptions& options, const Progress& progress);

/// The first `count` bytes of the object; `output` is a new file for them. Throws as fetchFile().
RemoteHead fetchObjectHead(const RemoteAddress& address, std::uint64_t count,
                           const std::filesystem::path& output, const RemoteOptions& options,
                           const Progress& progress);

}  // namespace lumen::convert
