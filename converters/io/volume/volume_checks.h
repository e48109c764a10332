// SPDX-License-Identifier: Apache-2.0
// What every volume must satisfy, whichever reader it came through.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Throws Error(InvalidInput), naming `path`, unless sizes are at least 2, spacings and origin are
/// sound and the direction is orthonormal within 1e-3; makes it orthonormal to rounding.
void checkGeometry(VolumeGeometry& geometry, const std::filesystem::path& path);

/// Throws Error(InvalidInput), naming `path` and `field`, unless `value` is a spacing; `axis`
/// counts from 1.
void checkStatedSpacing(const std::filesystem::path& path, const std::string& field, int axis,
                        double value);

/// Throws Error(InvalidInput) if `needed` bytes of voxels cannot come out of `available` bytes of a
/// file.
void checkRoom(const std::filesystem::path& path, double needed, double available, bool compressed);

/// Throws Error(InvalidInput) for another number of dimensions than three; `sizes` is "4 x 2".
[[noreturn]] void refuseDimensions(const std::filesystem::path& path, unsigned dimensions,
                                   const std::string& sizes);

/// The volume that is read of a file of `volumes` of equal size, from 0: `wanted`. Throws
/// Error(InvalidInput) where one of several is to be chosen, but is not, where the file does not have
/// it, and where a file of one volume leaves no choice.
std::uint64_t chosenVolume(const std::filesystem::path& path, const std::string& sizes,
                           std::uint64_t volumes, std::optional<int> wanted);

/// At most twelve significant digits, as headers of images state lengths and sizes.
std::string longNumber(double value);

}  // namespace lumen::convert
