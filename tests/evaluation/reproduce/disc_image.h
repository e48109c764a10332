// SPDX-License-Identifier: Apache-2.0
// Pixelated discs and the three interpolations of Yureidini's thesis, 3.8.2, in two dimensions.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace lumen::reproduce {

/// A square image; pixel (i, j) has its centre at ((i - (n-1)/2) S, (j - (n-1)/2) S).
struct Image {
  int n = 0;
  double spacing = 1;  ///< S
  std::vector<float> value;
  [[nodiscard]] float at(int i, int j) const;  ///< pixels beyond the border equal those on it
  [[nodiscard]] double index(double position) const { return position / spacing + 0.5 * (n - 1); }
};

/// A disc of radius 1 around (u, v) with `across` pixels to its diameter, over [-5, 5]^2: each
/// pixel has the share of it that lies in the disc.
Image discImage(int across, double u, double v);

/// The derivatives along both axes by the 3 x 3 mask whose norm does not change under rotations by
/// 45 degrees: centre row sqrt(2) - 1, each row beside it 1 - sqrt(2)/2 (Alvarez and Morel,
/// "Formalization and computational aspects of image analysis", 1994). The thesis names the method
/// and does not print its mask.
std::array<Image, 2> maskGradient(const Image& image);

/// The coefficients of the cubic B-spline that interpolates the image, mirrored at its border.
Image splineCoefficients(const Image& image);

enum class Interpolation { Linear, Cubic, Spline };

/// The pixels that an interpolation reads at a place, and their weights along each axis.
struct Stencil {
  int i = 0, j = 0;  ///< first pixel
  std::array<float, 4> wi{}, wj{};
};

/// Linear uses the inner two of four weights; Cubic is Keys' convolution with a = -1/2.
Stencil stencilAt(const Image& image, Interpolation interpolation, double u, double v);

/// Four images of one grid, interleaved.
struct Layers {
  int n = 0;
  std::vector<Eigen::Array4f> value;
};

/// The images in order; the layers beyond them are zero.
Layers interleave(const std::array<Image, 3>& images);

/// All layers, of pixels or of spline coefficients, at a place two pixels or more from the border.
Eigen::Array4f valueAt(const Layers& layers, const Stencil& stencil);

}  // namespace lumen::reproduce
