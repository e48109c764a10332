// SPDX-License-Identifier: Apache-2.0
// Units and axes of the folders that simulators load, from those of a case: mm, LPS.
#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

// Units of simulators in those of lumen, millimetres, and in SI units.

inline constexpr double kMetres = 1e-3, kCentimetres = 0.1;  ///< in a millimetre
inline constexpr double kCgsResistance = 1e-5;               ///< dyn s/cm^5 of Pa s/m^3

enum class LengthUnit : std::uint8_t { Millimetre, Centimetre, Metre };

/// Directions of the axes of a right-handed frame.
enum class Axes : std::uint8_t {
  Lps,  ///< x left, y posterior, z superior: that of a case, with z up
  Ras,  ///< x right, y anterior, z superior: that of 3D Slicer and NIfTI, with z up
  Lsa   ///< x left, y superior, z anterior: y up, as of glTF
};

std::string_view unitName(LengthUnit unit);  ///< "mm", "cm", "m"
std::string_view axesName(Axes axes);        ///< "LPS", "RAS", "LSA"
std::string_view upName(Axes axes);          ///< the axis that looks up: "y", "z"
std::string_view axesText(Axes axes);        ///< "x left, y posterior, z superior (up)"

/// A rotation of a case's frame, then a scale: nothing is mirrored or moved.
struct ExportFrame {
  LengthUnit unit = LengthUnit::Millimetre;
  Axes axes = Axes::Lps;

  [[nodiscard]] double scale() const;  ///< units in a millimetre
  [[nodiscard]] Eigen::Matrix3d rotation() const;
  /// A length, from mm.
  [[nodiscard]] double length(double mm) const { return scale() * mm; }
  /// A position, from mm, LPS.
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& lps) const;
  /// A unit vector, from LPS.
  [[nodiscard]] Eigen::Vector3d direction(const Eigen::Vector3d& lps) const;
  /// The homogeneous matrix that positions of the case are multiplied with, from the left.
  [[nodiscard]] Eigen::Matrix4d matrix() const;
  /// A surface of a case with its positions, normals and radii.
  [[nodiscard]] SurfaceMesh of(SurfaceMesh mesh) const;
};

/// A surface turned over: its normals look the other way, and its triangles run in the other sense.
SurfaceMesh turnedOver(SurfaceMesh mesh);

}  // namespace lumen::convert
