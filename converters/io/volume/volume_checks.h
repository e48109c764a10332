// SPDX-License-Identifier: Apache-2.0
// Requirements on every volume, whatever its reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Throws Error(InvalidInput), naming `path`, unless sizes are at least 2, spacings and origin are
/// sound and the direction is orthonormal within 1e-3; makes it orthonormal to rounding.
void checkGeometry(VolumeGeometry& geometry, const std::filesystem::path& path);

/// Sets voxels that are not a number to the least of the others, which becomes the padding, with a
/// sentence among the assumptions. Throws Error(InvalidInput), naming `path`, for infinite voxels, and
/// for voxels that are all equal unless that is allowed.
void checkVoxels(Volume& volume, const std::filesystem::path& path, bool allowsConstant = false);

/// Moves a volume that lies farther than 10 m from the origin along an axis (far_origin.h). The move is
/// a sentence among the assumptions.
void moveFarOrigin(VolumeGeometry& geometry, std::vector<std::string>& assumptions);

/// Throws Error(InvalidInput), naming `path` and `field`, unless `value` is a valid spacing; `axis`
/// counts from 1.
void checkStatedSpacing(const std::filesystem::path& path, const std::string& field, int axis,
                        double value, const FieldWord& word);

/// Throws Error(InvalidInput) if `available` bytes of a file cannot unpack to `needed` bytes of
/// voxels.
void checkRoom(const std::filesystem::path& path, double needed, double available, bool compressed);

/// Throws Error(InvalidInput) for another number of dimensions than three; `sizes` is "4 x 2".
[[noreturn]] void refuseDimensions(const std::filesystem::path& path, unsigned dimensions,
                                   const std::string& sizes);

/// The index, from 0, of the volume to read from a file of `volumes` of equal size, by the options.
/// Throws Error(InvalidInput) if a choice among several is missing, if the file does not have the
/// chosen volume, and if a choice is given for a file of one volume.
std::uint64_t chosenVolume(const std::filesystem::path& path, const std::string& sizes,
                           std::uint64_t volumes, const ReadVolumeOptions& options);

/// Most significant digits of lengths and sizes that headers of images state.
inline constexpr int kHeaderDigits = 12;

/// A number with at most kHeaderDigits significant digits.
std::string longNumber(double value);

}  // namespace lumen::convert
