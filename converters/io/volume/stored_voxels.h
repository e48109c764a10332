// SPDX-License-Identifier: Apache-2.0
// Voxels as the files of NRRD, MetaImage and NIfTI hold them, into memory: in one pass, with no more memory
// than the volume and what has come out of the files so far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

enum class PixelType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

/// Bytes of one voxel.
std::size_t sizeOf(PixelType type);
/// "int8" ... "float64".
std::string nameOf(PixelType type);

/// Deflate: a stream of zlib or gzip. Text: numbers between white space or commas. Hex: two digits a
/// byte.
enum class Packing { Raw, Deflate, Text, Hex };

struct StoredVoxels {
  std::filesystem::path header;              ///< whom to name in messages
  std::vector<std::filesystem::path> files;  ///< of equal parts of the voxels, in order
  std::uint64_t count = 0;                   ///< voxels in all files
  std::uint64_t first = 0;                   ///< the first of them that is wanted
  std::optional<std::uint64_t> wanted;       ///< how many are, if not all
  PixelType type = PixelType::UInt8;
  bool bigEndian = false;
  Packing packing = Packing::Raw;
  std::uint64_t offset = 0;    ///< in each file, bytes before those lines
  std::uint64_t lineSkip = 0;  ///< lines before the packed voxels
  /// Bytes before the voxels, of the unpacked stream; below 0: they end -1 - byteSkip bytes before
  /// the file does.
  std::int64_t byteSkip = 0;
  std::optional<std::uint64_t> packedSize;  ///< bytes of the packed stream, if the header says
  /// Factor of the stored values, and what is added then; the result is float.
  struct Scaling {
    double slope = 1, intercept = 0;
  };
  std::optional<Scaling> scaling;

  /// The voxels that are read.
  [[nodiscard]] std::uint64_t wantedCount() const { return wanted.value_or(count - first); }
};

/// Bytes of the files. Throws Error(InvalidInput) unless they can hold the voxels: raw ones exactly,
/// others by what their packing can expand to. What a raw file holds beyond its voxels is appended
/// to `assumptions`.
std::uint64_t checkStored(const StoredVoxels& stored, std::vector<std::string>& assumptions);

/// The voxels, after checkStored(). Throws Error(InvalidInput) for what is truncated or damaged, and
/// Error(Cancelled); appends to `assumptions` what goes on after the voxels.
Voxels readStored(const StoredVoxels& stored, const Progress& progress,
                  std::vector<std::string>& assumptions);

}  // namespace lumen::convert
