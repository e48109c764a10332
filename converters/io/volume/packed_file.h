// SPDX-License-Identifier: Apache-2.0
// One file of voxels, unpacked while it is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "converters/base/input_file.h"
#include "converters/io/volume/stored_voxels.h"

namespace lumen::convert {

class PackedFile {
public:
  PackedFile() = default;
  virtual ~PackedFile() = default;
  PackedFile(const PackedFile&) = delete;
  PackedFile& operator=(const PackedFile&) = delete;

  /// The next bytes of the voxels, `size` of them unless the file ends before: in this machine's
  /// byte order if the voxels are text, in the file's otherwise. Throws Error(InvalidInput) if they
  /// are damaged.
  virtual std::size_t read(std::byte* to, std::size_t size) = 0;
  /// True if more bytes follow. Throws Error(InvalidInput) if the stream ends wrongly.
  virtual bool hasMore() = 0;
};

/// Opens `file` of `stored`, which must hold `size` bytes of voxels. Throws Error(InvalidInput) if
/// it cannot be opened or ends before its voxels, and Error(Cancelled).
std::unique_ptr<PackedFile> openPacked(const StoredVoxels& stored, const InputFile& file,
                                       std::uint64_t size, const Progress& progress);

}  // namespace lumen::convert
