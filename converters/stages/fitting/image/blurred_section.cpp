// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/blurred_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/field/repeatable_math.h"

namespace lumen::convert::fitting {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Standard deviations between corners, at most. The sum over a closed smooth curve converges
/// faster than any power: at 1 the derivatives are exact to 1e-4.
constexpr double kCornerStep = 1.0;
constexpr int kFewestCorners = 16, kMostCorners = 192;
/// Standard deviations beyond which a wall's image is even: the tail of a Gaussian is 3e-5 there.
constexpr double kReach = 4;
/// Half the square of the distance of a corner, in standard deviations, beyond which its Gaussian is 0.
constexpr double kFarCorner = 12;
/// The least share of the radius to which taper and flare may narrow a section.
constexpr double kLeastShare = 0.05;

}  // namespace

double Outline::at(double a) const {
  double sum = radius;
  for (int m = 2; m <= harmonics; ++m) {
    const auto i = static_cast<std::size_t>(m - 2);
    sum += cosine[i] * std::cos(m * a) + sine[i] * std::sin(m * a);
  }
  return sum;
}

double Outline::area() const {
  double square = radius * radius;
  for (int m = 2; m <= harmonics; ++m) {
    const auto i = static_cast<std::size_t>(m - 2);
    square += 0.5 * (cosine[i] * cosine[i] + sine[i] * sine[i]);
  }
  return std::numbers::pi * square;
}

void addTo(Outline& outline, const Eigen::VectorXd& step) {
  outline.centre += step.segment<2>(kCentre);
  outline.tilt += step.segment<2>(kTilt);
  outline.bend += step.segment<2>(kBend);
  outline.radius += step[kRadius];
  outline.taper += step[kTaper];
  outline.flare += step[kFlare];
  for (int m = 2; m <= outline.harmonics; ++m) {
    const auto i = static_cast<std::size_t>(m - 2);
    outline.cosine[i] += step[kWaves + 2 * (m - 2)];
    outline.sine[i] += step[kWaves + 2 * (m - 2) + 1];
  }
}

BlurredSection::BlurredSection(const Outline& outline, const Eigen::Matrix2d& covariance)
    : m_outline(outline), m_along(0.5 * covariance.trace()) {
  const double l11 = std::sqrt(covariance(0, 0)), l21 = covariance(1, 0) / l11;
  const double l22 = std::sqrt(std::max(covariance(1, 1) - l21 * l21, 1e-12));
  m_white << 1 / l11, 0, -l21 / (l11 * l22), 1 / l22;
  m_reach = kReach * std::max(l11, std::sqrt(covariance(1, 1)));
  const double corners = kTurn * outline.radius / (kCornerStep * std::min(l11, l22));
  const int count = std::clamp(static_cast<int>(std::ceil(corners)), kFewestCorners, kMostCorners);
  m_step = kTurn / count;
  for (int k = 0; k < count; ++k) {
    const double a = k * m_step;
    Corner corner{std::cos(a), std::sin(a), outline.radius, 0};
    auto& waves = m_waves.emplace_back();
    for (int m = 2; m <= outline.harmonics; ++m) {
      const auto i = static_cast<std::size_t>(m - 2);
      const double c = std::cos(m * a), s = std::sin(m * a);
      corner.radius += outline.cosine[i] * c + outline.sine[i] * s;
      corner.slope += m * (outline.sine[i] * c - outline.cosine[i] * s);
      waves[2 * i] = c;
      waves[2 * i + 1] = s;
    }
    m_corners.push_back(corner);
    m_most = std::max(m_most, corner.radius);
    m_least = std::min(m_least, corner.radius);
  }
}

/// 1 or 0 at a place, relative to the centre, that is far inside or outside of the wall.
std::optional<double> BlurredSection::farFromWall(const Eigen::Vector2d& p, double wider) const {
  const double r = p.norm();
  if (r > m_most + wider + m_reach) return 0.0;
  if (r < m_least + wider - m_reach) return 1.0;
  return std::nullopt;
}

template <bool derives>
BlurredSection::Value BlurredSection::evaluate(const Eigen::Vector2d& point, double height,
                                               double* out) const {
  const Outline& o = m_outline;
  const int parameters = parameterCount(o);
  if (derives) std::fill(out, out + parameters, 0.0);
  const double half2 = 0.5 * (height * height + m_along);
  const Eigen::Vector2d p = point - o.centre - o.tilt * height - o.bend * half2;
  const double wider = std::max(o.taper * height + o.flare * half2, (kLeastShare - 1) * o.radius);
  if (const auto even = farFromWall(p, wider)) return {*even, 0};
  const double w11 = m_white(0, 0), w21 = m_white(1, 0), w22 = m_white(1, 1);
  const double x = w11 * p.x(), y = w21 * p.x() + w22 * p.y();
  double flux = 0, blur = 0, sumX = 0, sumY = 0, sumR = 0;
  std::array<double, 2 * (kMostHarmonics - 1)> sums{};
  const std::size_t waves = 2 * static_cast<std::size_t>(o.harmonics - 1);
  for (std::size_t k = 0; k < m_corners.size(); ++k) {
    const Corner& corner = m_corners[k];
    const double r = corner.radius + wider;
    const double tx = corner.slope * corner.cosine - r * corner.sine;
    const double ty = corner.slope * corner.sine + r * corner.cosine;
    const double dx = w11 * r * corner.cosine - x;
    const double dy = w21 * r * corner.cosine + w22 * r * corner.sine - y;
    const double across = dx * (w21 * tx + w22 * ty) - dy * (w11 * tx);
    const double half = 0.5 * (dx * dx + dy * dy);
    if (half > kFarCorner) {
      flux += across / (2 * half);
      continue;
    }
    const double e = field::expOfMinus(half);
    flux += across * (half > 1e-6 ? (1 - e) / (2 * half) : 0.5);
    blur -= across * e;
    if (!derives) continue;
    sumX += e * ty;
    sumY -= e * tx;
    const double radial = e * r;
    sumR += radial;
    for (std::size_t i = 0; i < waves; ++i) sums[i] += radial * m_waves[k][i];
  }
  const double scale = m_step / kTurn;
  if (derives) {
    const double area = scale * w11 * w22;
    const double powers[3] = {1, height, half2};
    for (int i = 0; i < 3; ++i) {
      out[kCentre + 2 * i] = area * sumX * powers[i];
      out[kCentre + 2 * i + 1] = area * sumY * powers[i];
      out[kRadius + i] = area * sumR * powers[i];
    }
    for (std::size_t i = 0; i < waves; ++i) out[kWaves + i] = area * sums[i];
  }
  return {scale * flux, scale * blur};
}

BlurredSection::Value BlurredSection::at(const Eigen::Vector2d& point, double height) const {
  return evaluate<false>(point, height, nullptr);
}

BlurredSection::Value BlurredSection::derivatives(const Eigen::Vector2d& point, double height,
                                                  double* out) const {
  return evaluate<true>(point, height, out);
}

}  // namespace lumen::convert::fitting
