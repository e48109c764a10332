// SPDX-License-Identifier: Apache-2.0
// Lengths as users write them: in millimetres or in radii of the vessel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace lumen::convert {

/// A length as the sum of both parts.
struct Length {
  double mm = 0;
  double radii = 0;  ///< multiple of the vessel's radius
  [[nodiscard]] double at(double radius) const { return mm + radii * radius; }
  friend bool operator==(const Length&, const Length&) = default;
};

/// The greatest distance that a surface may have from its field: the larger of both.
struct SurfaceError {
  double mm = 0;
  double radii = 0;   ///< multiple of the vessel's radius
  double voxels = 0;  ///< multiple of the voxel size; inMillimetres() adds it to `mm`
  [[nodiscard]] double at(double radius) const { return std::max(mm, radii * radius); }
  friend bool operator==(const SurfaceError&, const SurfaceError&) = default;
};

/// The same error with voxels of that size, mm, as millimetres.
inline SurfaceError inMillimetres(const SurfaceError& error, double voxelSize) {
  return {std::max(error.mm, error.voxels * voxelSize), error.radii, 0};
}

/// The usual error: a tenth of a voxel, about what a fit leaves, or what twelve edges around a
/// vessel leave, whichever is larger.
constexpr SurfaceError kUsualSurfaceError{0, 0.03, 0.1};
constexpr std::string_view kUsualSurfaceErrorText = "0.1v,0.03r";

/// Parses an error: "0.05" and "0.05mm" are millimetres, "0.03r" radii, "0.1v" voxels, "0.1v,0.03r" is
/// the larger of both, and "0" is none. Throws Error(Usage), with `option` in the sentence, unless the
/// numbers are finite and not negative.
SurfaceError parseSurfaceError(std::string_view text, const std::string& option);

/// Parses a length: "0.5" and "0.5mm" are millimetres, "5r" are radii. Throws Error(Usage), with
/// `option` in the sentence, unless the number is finite and above 0.
Length parseLength(std::string_view text, const std::string& option);

/// A length for every end, or for the ends of one branch.
struct EndLength {
  std::string label;  ///< label of the branch; empty: every branch that no other names
  Length length;
  friend bool operator==(const EndLength&, const EndLength&) = default;
};

/// Parses "5r", or "LABEL=5r". A label may contain "=": the last one counts. Throws as
/// parseLength().
EndLength parseEndLength(std::string_view text, const std::string& option);

// Walls of vessels that touch.

enum class Touching : std::uint8_t {
  Share,  ///< they have one wall between them
  Apart   ///< each has its own, and a gap is between them
};

}  // namespace lumen::convert
