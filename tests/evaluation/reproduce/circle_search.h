// SPDX-License-Identifier: Apache-2.0
// Circles from the wall points that rays find in a pixelated disc (Yureidini's thesis, 3.8.2).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "converters/base/random.h"
#include "disc_image.h"

namespace lumen::reproduce {

constexpr std::size_t kConfigurations = 9;
constexpr std::size_t kSearches = kConfigurations + 1;
/// In the order of thesis table 3.2; the last is not in it: as the tracker does it, by cubic
/// B-spline and central differences with a parabola through the steepest place and least squares on
/// the inliers.
extern const std::array<const char*, kSearches> kSearchNames;

struct WallPoints {
  std::vector<float> u, v;  ///< relative to the focus
};

/// The points that the tracker would keep: from a 12th to 8/10 of a ray away.
WallPoints trimmed(const WallPoints& points);

struct Circle {
  double u = 0, v = 0, radius = 0;  ///< relative to the focus; no radius: none was found
};

/// An image, its derivatives, and the spline coefficients of all three.
class DiscSampler {
public:
  explicit DiscSampler(const Image& image);

  /// Points along 128 rays of 128 samples and length 2.5 from the focus, by each configuration.
  void cast(double focusU, double focusV, std::array<WallPoints, kSearches>& out);

private:
  void sampleRay(Interpolation interpolation, double focusU, double focusV, double du, double dv);

  Image m_image;
  Layers m_pixels, m_splines;             // value, and its derivatives along u and v
  std::vector<float> m_values, m_slopes;  // along a ray, the slopes from the derivatives
};

/// RANSAC with the tracker's parameters: 220 to 500 triples, accepted at an inlier rate of 0.7, a
/// band of a tenth of the radius, radii in [0.5, 1.5], and circles that hold the focus.
Circle detectCircle(const WallPoints& points, Random& random);
/// The circle of least squared distances to the points in its band, which are chosen anew thrice.
Circle refineCircle(const WallPoints& points, Circle circle);

}  // namespace lumen::reproduce
