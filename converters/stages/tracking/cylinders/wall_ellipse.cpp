// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/wall_ellipse.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The most rounds of reweighting, and the relative change of the unknowns below which they end.
constexpr int kReweightings = 12;
constexpr double kEllipseConverged = 1e-3;
/// Standard deviations beyond which a point has no weight (J. Tukey's biweight).
constexpr double kBiweightDeviations = 4.685;
/// The largest ratio of a section's axes: a longer one is two vessels. Rays of kRayRadii show it in
/// full around a circle that fits between its sides.
constexpr double kLargestAxisRatio = 2.5;

EllipseUnknowns rowAt(double angle, double along) {
  EllipseUnknowns row;
  row << 1.0, std::cos(angle), std::sin(angle), std::cos(2 * angle), std::sin(2 * angle), along,
      along * along;
  return row;
}

/// Amplitude of the wall's wave of twice the angle.
double oblong(const EllipseUnknowns& curve) {
  return std::hypot(curve[3], curve[4]);
}

}  // namespace

double WallEllipse::wallAt(const WallPlace& place) const {
  const double inverse = place.row.dot(curve);
  return inverse > 0 ? 1.0 / std::sqrt(inverse) : std::numeric_limits<double>::infinity();
}

bool WallEllipse::isValid() const {
  constexpr double kSquare = kLargestAxisRatio * kLargestAxisRatio;
  return curve.allFinite() && curve[0] > 0 &&
         oblong(curve) <= (kSquare - 1) / (kSquare + 1) * curve[0];
}

double WallEllipse::radius() const {
  const double wave = oblong(curve);
  return std::pow(curve[0] * curve[0] - wave * wave, -0.25);
}

Eigen::Vector2d WallEllipse::middle() const {
  return -0.5 * std::pow(curve[0], -1.5) * Eigen::Vector2d(curve[1], curve[2]);
}

void measureAbout(const Vector3d& centre, const Vector3d& axis, std::vector<WallPlace>& places) {
  const auto [u, v] = planeBasis(axis);
  for (WallPlace& p : places) {
    const Vector3d offset = p.position - centre;
    const double a = offset.dot(u), b = offset.dot(v);
    p.angle = std::atan2(b, a);
    p.distance = std::hypot(a, b);
    p.row = rowAt(p.angle, offset.dot(axis));
  }
}

WallEllipse fitEllipse(const std::vector<WallPlace>& places, double radius) {
  WallEllipse ellipse;
  ellipse.curve[0] = 1.0 / (radius * radius);
  for (int round = 0; round < kReweightings && ellipse.isValid(); ++round) {
    std::vector<double> walls, residuals;
    for (const WallPlace& p : places) {
      walls.push_back(ellipse.wallAt(p));
      residuals.push_back(std::abs(p.distance - walls.back()));
    }
    const double scale = std::max(kDeviationOfMedian * median(residuals), 1e-3 * radius);
    Eigen::Matrix<double, kEllipseUnknowns, kEllipseUnknowns> normal;
    normal.setZero();
    EllipseUnknowns right = EllipseUnknowns::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double t = residuals[i] / (kBiweightDeviations * scale);
      if (t >= 1) continue;
      // move of the wall for a change of the inverse square
      const double slope = 0.5 * walls[i] * walls[i] * walls[i];
      const double weight = (1 - t * t) * (1 - t * t) * slope * slope;
      const double distance = std::max(places[i].distance, 1e-3 * radius);
      normal += weight * places[i].row * places[i].row.transpose();
      right += weight / (distance * distance) * places[i].row;
    }
    normal.diagonal().array() += 1e-9 * normal.trace();
    const EllipseUnknowns next = normal.ldlt().solve(right);
    const bool isDone = (next - ellipse.curve).norm() < kEllipseConverged * ellipse.curve.norm();
    ellipse.curve = next;
    if (isDone) break;
  }
  return ellipse;
}

std::size_t sectorsWith(const std::vector<WallPlace>& places) {
  std::bitset<kSectors> seen;
  for (const WallPlace& p : places) {
    const double turn = p.angle / (2 * std::numbers::pi) + 0.5;
    seen.set(std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1));
  }
  return seen.count();
}

}  // namespace lumen::convert
