// SPDX-License-Identifier: Apache-2.0
// Voxels as stored in files of NRRD, MetaImage and NIfTI, read into memory in one pass, with no
// more memory than the volume and the data unpacked so far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

enum class PixelType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

/// Calls `use` with a zero of this type.
template <class Use>
auto withPixelType(PixelType type, const Use& use) {
  switch (type) {
    case PixelType::Int8:
      return use(std::int8_t{});
    case PixelType::UInt8:
      return use(std::uint8_t{});
    case PixelType::Int16:
      return use(std::int16_t{});
    case PixelType::UInt16:
      return use(std::uint16_t{});
    case PixelType::Int32:
      return use(std::int32_t{});
    case PixelType::UInt32:
      return use(std::uint32_t{});
    case PixelType::Int64:
      return use(std::int64_t{});
    case PixelType::UInt64:
      return use(std::uint64_t{});
    case PixelType::Float32:
      return use(float{});
    case PixelType::Float64:
      break;
  }
  return use(double{});
}

/// Size of one voxel, bytes.
std::size_t sizeOf(PixelType type);
/// Name of a type, "int8" ... "float64".
std::string nameOf(PixelType type);

/// Deflate: a stream of zlib or gzip. Text: numbers between white space or commas. Hex: two digits
/// a byte.
enum class Packing { Raw, Deflate, Text, Hex };

struct StoredVoxels {
  std::filesystem::path header;         ///< file named in messages
  std::vector<InputFile> files;         ///< files with equal parts of the voxels, in order
  std::uint64_t count = 0;              ///< voxels in all files
  std::uint64_t first = 0;              ///< index of the first wanted voxel
  std::optional<std::uint64_t> wanted;  ///< number of wanted voxels; empty: all
  /// Interleaved volumes: `together` voxels of one, then as many of the next, and `first` is 0. 0: the
  /// wanted voxels follow one another.
  std::uint64_t together = 0, volumes = 1, volume = 0;
  PixelType type = PixelType::UInt8;
  bool bigEndian = false;
  Packing packing = Packing::Raw;
  std::uint64_t offset = 0;    ///< bytes before the lines of lineSkip, in each file
  std::uint64_t lineSkip = 0;  ///< lines before the packed voxels
  /// Bytes before the voxels in the unpacked stream; below 0: the voxels end -1 - byteSkip bytes
  /// before the end of the file.
  std::int64_t byteSkip = 0;
  std::optional<std::uint64_t> packedSize;  ///< bytes of the packed stream, if stated
  /// Factor of the stored values, and the addend; the result is float.
  struct Scaling {
    double slope = 1, intercept = 0;
  };
  std::optional<Scaling> scaling;

  /// The number of voxels to read.
  [[nodiscard]] std::uint64_t wantedCount() const { return wanted.value_or(count - first); }
};

/// Total size of the files, bytes. Throws Error(InvalidInput) unless they can hold the voxels: raw
/// ones exactly, others up to the maximum expansion of their packing. A sentence about data beyond
/// the voxels of a raw file is appended to `assumptions`.
std::uint64_t checkStored(const StoredVoxels& stored, std::vector<std::string>& assumptions);

/// The voxels, after checkStored(). Throws Error(InvalidInput) for truncated or damaged data, and
/// Error(Cancelled); a sentence about data after the voxels is appended to `assumptions`.
Voxels readStored(const StoredVoxels& stored, const Progress& progress,
                  std::vector<std::string>& assumptions);

}  // namespace lumen::convert
