// SPDX-License-Identifier: Apache-2.0
#include "circle_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "converters/stages/tracking/cylinder.h"

namespace lumen::reproduce {

const std::array<const char*, kSearches> kSearchNames = {"L + FD",  "L + CD",    "C + FD", "C + CD",
                                                         "BS + FD", "BS + CD",   "AM + L", "AM + C",
                                                         "AM + BS", "as tracked"};

namespace {

constexpr std::size_t kRays = 128, kSamples = 128;
constexpr double kLength = 2.5, kStep = kLength / (kSamples - 1);
constexpr double kAccepted = 0.7;
constexpr float kBand = 0.1F;
constexpr std::size_t kFewestTrials = 220, kMostTrials = 500;

/// Where the slope is smallest, in samples; the first such place.
template <class Slope>
std::size_t steepest(std::size_t first, std::size_t end, Slope slope) {
  std::size_t best = first;
  for (std::size_t k = first + 1; k < end; ++k)
    if (slope(k) < slope(best)) best = k;
  return best;
}

/// The minimum of the parabola through a slope and its neighbours, relative to the middle one.
double parabola(float before, float middle, float after) {
  const auto bend = static_cast<double>(before - 2 * middle + after);
  return bend > 0 ? std::clamp(0.5 * static_cast<double>(before - after) / bend, -1.0, 1.0) : 0.0;
}

}  // namespace

WallPoints trimmed(const WallPoints& points) {
  WallPoints out;
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    const auto t = static_cast<double>(std::hypot(points.u[i], points.v[i]));
    if (t < kLength / 12 || t > 0.8 * kLength) continue;
    out.u.push_back(points.u[i]);
    out.v.push_back(points.v[i]);
  }
  return out;
}

DiscSampler::DiscSampler(const Image& image)
    : m_image(image), m_values(kSamples), m_slopes(kSamples) {
  auto [u, v] = maskGradient(image);
  m_pixels = interleave({image, u, v});
  m_splines = interleave({splineCoefficients(image), splineCoefficients(u), splineCoefficients(v)});
}

void DiscSampler::sampleRay(Interpolation interpolation, double focusU, double focusV, double du,
                            double dv) {
  const Layers& layers = interpolation == Interpolation::Spline ? m_splines : m_pixels;
  const auto fu = static_cast<float>(du), fv = static_cast<float>(dv);
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double t = kStep * static_cast<double>(k);
    const Eigen::Array4f at =
        valueAt(layers, stencilAt(m_image, interpolation, focusU + t * du, focusV + t * dv));
    m_values[k] = at[0];
    m_slopes[k] = fu * at[1] + fv * at[2];
  }
}

void DiscSampler::cast(double focusU, double focusV, std::array<WallPoints, kSearches>& out) {
  for (WallPoints& points : out) points.u.clear(), points.v.clear();
  const auto forward = [&](std::size_t k) { return m_values[k + 1] - m_values[k]; };
  const auto central = [&](std::size_t k) { return m_values[k + 1] - m_values[k - 1]; };
  const auto mask = [&](std::size_t k) { return m_slopes[k]; };
  for (std::size_t r = 0; r < kRays; ++r) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(r) / kRays;
    const double du = std::cos(angle), dv = std::sin(angle);
    const auto add = [&](double sample, std::size_t to) {
      out[to].u.push_back(static_cast<float>(kStep * sample * du));
      out[to].v.push_back(static_cast<float>(kStep * sample * dv));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      sampleRay(static_cast<Interpolation>(i), focusU, focusV, du, dv);
      add(static_cast<double>(steepest(0, kSamples - 1, forward)), 2 * i);
      const std::size_t best = steepest(1, kSamples - 1, central);
      add(static_cast<double>(best), 2 * i + 1);
      add(static_cast<double>(steepest(0, kSamples, mask)), 6 + i);
      if (i != 2 || best < 2 || best + 2 >= kSamples) continue;
      const double shift = parabola(central(best - 1), central(best), central(best + 1));
      add(static_cast<double>(best) + shift, kConfigurations);
    }
  }
}

Circle detectCircle(const WallPoints& points, Random& random) {
  const std::size_t count = points.u.size();
  if (count < 3) return {};
  const auto accepted = static_cast<int>(std::ceil(kAccepted * static_cast<double>(count)));
  Circle best;
  int most = 0;
  convert::CircleBlock block;
  for (std::size_t trial = 0; trial < kMostTrials; trial += convert::kCircleBlock) {
    if (trial >= kFewestTrials && most >= accepted) break;
    convert::drawTriples(points.u, points.v, random, block);
    convert::circlesThrough(block, 0.5F, 1.5F);
    for (std::size_t t = 0; t < convert::kCircleBlock; ++t) {
      const float radius = std::sqrt(block.squaredRadius[t]);
      if (radius == 0) continue;
      const float inner = radius * (1 - kBand), outer = radius * (1 + kBand);
      const int inliers = convert::countInBand(points.u.data(), points.v.data(), count, block.u[t],
                                               block.v[t], inner * inner, outer * outer);
      if (inliers <= most) continue;
      most = inliers;
      best = {static_cast<double>(block.u[t]), static_cast<double>(block.v[t]),
              static_cast<double>(radius)};
    }
  }
  return best;
}

Circle refineCircle(const WallPoints& points, Circle circle) {
  for (int round = 0; round < 3 && circle.radius > 0; ++round) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.u.size(); ++i) {
      const double u = static_cast<double>(points.u[i]) - circle.u;
      const double v = static_cast<double>(points.v[i]) - circle.v;
      const double distance = std::hypot(u, v), residual = distance - circle.radius;
      if (distance == 0 || std::abs(residual) > static_cast<double>(kBand) * circle.radius)
        continue;
      const Eigen::Vector3d row(-u / distance, -v / distance, -1);
      normal += row * row.transpose();
      right -= residual * row;
    }
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    circle = {circle.u + step[0], circle.v + step[1], circle.radius + step[2]};
  }
  return circle;
}

}  // namespace lumen::reproduce
