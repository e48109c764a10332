// SPDX-License-Identifier: Apache-2.0
// The header of a NIfTI-1 file, read strictly: each field that determines voxels or their place is
// checked against its definition (nifti1.h of the NIfTI data format working group) before its use.
// No library is involved: niftiio repairs such fields silently.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "converters/base/input_file.h"
#include "converters/io/volume/stored_voxels.h"

namespace lumen::convert {

constexpr std::size_t kNiftiHeaderSize = 348;
/// The smallest offset of the voxels, bytes: the header and the four bytes that announce extensions
/// come first.
constexpr std::size_t kNiftiFirstVoxel = 352;

struct NiftiHeader {
  bool swapped = false;       ///< the file's byte order is not this machine's
  std::array<int, 3> size{};  ///< voxels along i, j, k; at least 1
  std::uint64_t volumes = 1;  ///< number of volumes of that size
  std::string sizes;          ///< sizes along all axes, such as "4 x 2 x 2 x 9"
  PixelType type = PixelType::UInt8;
  std::size_t voxelOffset = 0;     ///< bytes before the first voxel; at least 352
  std::array<float, 3> pixdim{};   ///< spacings in the file's unit, unchecked
  float handedness = 1;            ///< qfac, pixdim[0], unchecked
  float slope = 0, intercept = 0;  ///< finite; a slope of 0 means no scaling
  bool isSlopeMissing = false;     ///< the slope is not a number (NaN), which stands for no scaling
  int unitCode = 0;  ///< unit of lengths: 1 m, 2 mm, 3 um, 0 unknown; others are undefined
  int qformCode = 0, sformCode = 0;              ///< 0: the transform is not stated
  std::array<float, 3> quaternion{}, qOffset{};  ///< unchecked
  std::array<std::array<float, 4>, 3> sform{};   ///< rows, unchecked

  [[nodiscard]] std::size_t voxelCount() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  [[nodiscard]] bool isScaled() const { return slope != 0 && (slope != 1 || intercept != 0); }
};

/// Throws Error(InvalidInput), naming `path`, unless bytes begin with a NIfTI-1 header in either
/// byte order; Error(Unsupported) for NIfTI-2.
void checkNiftiStart(std::span<const std::byte, kNiftiHeaderSize> bytes,
                     const std::filesystem::path& path);

/// The header in `bytes`, the first 348 of a file. Throws Error(InvalidInput), naming `path` and
/// the field, unless it describes a single file of scalar volumes; Error(Unsupported) for NIfTI-2,
/// for a header whose voxels are in another file, and for types that are not read.
NiftiHeader parseNiftiHeader(std::span<const std::byte, kNiftiHeaderSize> bytes,
                             const std::filesystem::path& path);

/// The bytes between header and voxels of a file, in which extensions lie, at most a megabyte;
/// empty for a file that is no NIfTI-1 or has none.
std::string niftiExtensions(const InputFile& file);

}  // namespace lumen::convert
