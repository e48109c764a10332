// SPDX-License-Identifier: Apache-2.0
// Marks in the margins of a picture: its scale, the sides of the patient, the meaning of colours.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/draw/picture/camera.h"
#include "converters/draw/raster/picture.h"

namespace lumen::convert {

/// Pixels that marks take above and below a picture; 0 where it is narrower or lower than 160 and
/// has none.
int roomForMarks(int width, int height);

/// A bar of 1, 2 or 5 times a power of ten millimetres, and its length in mm.
struct ScaleBar {
  double length = 0;  ///< mm
  int pixels = 0;
};
/// The longest that takes at most a fifth of the picture's width.
ScaleBar makeScaleBar(const Camera& camera);

/// The bar in the lower left corner, with its length.
void drawScaleBar(Picture& picture, const Camera& camera, const Rgb& ink);

/// The side of the patient towards which a direction (unit, LPS) points: L, R, P, A, S or I, or
/// several, the nearest first, where it lies more than 22.5 degrees off the first.
std::string sidesTowards(const Eigen::Vector3d& direction);

/// The sides in the middle of the picture's four edges.
void drawSides(Picture& picture, const Camera& camera, const Rgb& ink);

/// Meaning of the colours of a picture.
struct Legend {
  std::string title;         ///< title, with the unit
  std::vector<Rgb> colours;  ///< colours from left to right
  /// Numbers at even distances below, the first at the left end, three at most; or a name for each
  /// colour, above it, with the title at the left.
  std::vector<std::string> values;
};
/// Draws the legend in the lower right corner.
void drawLegend(Picture& picture, const Legend& legend, const Rgb& ink);

}  // namespace lumen::convert
