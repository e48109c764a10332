// SPDX-License-Identifier: Apache-2.0
// The image of a vessel's cross-section (docs/method.md, section 2.11): the share of a Gaussian
// point-spread function that lies in it, with its derivatives by the shape.
//
// The integral over the section becomes one along its outline: with g the Gaussian and d = |y - x|,
// the field (y - x) (1 - exp(-d^2 / 2)) / (2 pi d^2), in units of the Gaussian, has the divergence
// g(y - x). So the image is exact for every outline, also of vessels narrower than the blur, and its
// derivative by a move of the outline is g along it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert::fitting {

/// The highest harmonic of an outline.
constexpr int kMostHarmonics = 8;

/// A star-shaped outline that changes along the axis. At the height h its points are
///
///     centre + tilt h + bend h^2/2 + (radius + taper h + flare h^2/2 + sum_m wave) (cos a, sin a),
///
/// wave = cosine[m-2] cos(m a) + sine[m-2] sin(m a), m = 2 .. harmonics. Lengths are mm; the plane's
/// axes belong to the owner.
struct Outline {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), tilt = Eigen::Vector2d::Zero(),
                  bend = Eigen::Vector2d::Zero();
  double radius = 0, taper = 0, flare = 0;
  int harmonics = 1;  ///< 1: a circle
  std::array<double, kMostHarmonics - 1> cosine{}, sine{};

  /// The distance of the wall from the centre at the angle `a` and the height 0, mm.
  [[nodiscard]] double at(double a) const;
  /// The area at the height 0, mm^2.
  [[nodiscard]] double area() const;
};

/// Parameters of an outline, in the order of the derivatives: centre, tilt, bend (two each), radius,
/// taper, flare, then cosine and sine of each harmonic.
constexpr int kCentre = 0, kTilt = 2, kBend = 4, kRadius = 6, kTaper = 7, kFlare = 8, kWaves = 9;
constexpr int kMostParameters = kWaves + 2 * (kMostHarmonics - 1);

/// The number of parameters of an outline.
inline int parameterCount(const Outline& outline) {
  return kWaves + 2 * (outline.harmonics - 1);
}
/// Adds a step to the parameters.
void addTo(Outline& outline, const Eigen::VectorXd& step);

/// The image of one outline. Along the axis the point-spread function is taken to be as wide as
/// across it; over its width the outline is averaged to second order. Immutable; any number of threads may query it.
class BlurredSection {
public:
  /// `covariance`: of the point-spread function in the plane, mm^2, positive definite.
  BlurredSection(const Outline& outline, const Eigen::Matrix2d& covariance);

  struct Value {
    double share = 0;  ///< of the point-spread function in the section, 0 to 1 up to rounding
    double wider = 0;  ///< derivative by the logarithm of the blur's width
  };
  /// The image at `point` of the plane at the height `height`.
  [[nodiscard]] Value at(const Eigen::Vector2d& point, double height) const;
  /// at(), with the derivatives by the parameters in `out`, parameterCount() of them.
  Value derivatives(const Eigen::Vector2d& point, double height, double* out) const;

private:
  struct Corner {
    double cosine, sine, radius, slope;  ///< slope: derivative of the radius by the angle
  };

  [[nodiscard]] std::optional<double> farFromWall(const Eigen::Vector2d& p, double wider) const;
  template <bool derives>
  Value evaluate(const Eigen::Vector2d& point, double height, double* out) const;

  Outline m_outline;
  Eigen::Matrix2d m_white;  ///< from mm to units of the Gaussian; lower triangular
  double m_along;           ///< variance of the point-spread function along the axis, mm^2
  double m_step, m_reach;  ///< angle between corners; mm of distance beyond which the image is even
  double m_most = 0, m_least = std::numeric_limits<double>::infinity();  ///< radii of the outline
  std::vector<Corner> m_corners;
  std::vector<std::array<double, 2 * (kMostHarmonics - 1)>> m_waves;
};

}  // namespace lumen::convert::fitting
