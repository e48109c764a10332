// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/smooth_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr int kMostTerms = 6;             // of a polynomial of fifth degree
constexpr std::size_t kFewestNodes = 15;  // nodes of a window: 2.5 for each unknown
constexpr double kGridRadii = 0.3;        // step of the table of arc lengths, in local radii
constexpr int kMostPieces = 16;           // of that table between two nodes
constexpr double kWholeShare = 0.5;       // of a half-width that an end may cut off
constexpr double kWindowRim = 1e-6;       // share of a window by which it passes a node at its rim
constexpr double kSignificant = 1.96;     // standard deviations: 95 %
// A helix that turns by w = sqrt(curvature^2 + torsion^2) per mm loses by the fit this share of
// (half-width x w)^4 of its curvature: the next term of its series, projected on the fit's
// polynomials with biweight weights. The curvature is corrected by it.
constexpr double kCurvatureLoss = 6.4e-4;
constexpr double kMostCorrection = 0.1;  // beyond, the series no longer holds
constexpr double kTorsionBias = 3e-4;    // bound of the same share of a helix's torsion

using Coefficients = Eigen::Matrix<double, kMostTerms, 1>;
using Square = Eigen::Matrix<double, kMostTerms, kMostTerms>;

double biweight(double x) {
  const double rest = 1 - x * x;
  return rest > 0 ? rest * rest : 0;
}

double factorial(int n) {
  return n <= 1 ? 1 : n * factorial(n - 1);
}

}  // namespace

/// The polynomial around a parameter, in units of its half-width.
struct SmoothAxis::Fit {
  double half = 0;
  double cut = 0;  ///< share of the half-width that an end cuts off
  int terms = 0;
  Eigen::Matrix<double, kMostTerms, 3> coefficient = Eigen::Matrix<double, kMostTerms, 3>::Zero();
  Coefficients variance = Coefficients::Zero();  ///< of each coefficient, for centres of variance 1
  double leverage = 0;                           ///< of a node that lies there

  /// Derivative to the parameter, in mm.
  [[nodiscard]] Vector3d derivative(int order) const {
    return factorial(order) / std::pow(half, order) * coefficient.row(order).transpose();
  }
  [[nodiscard]] double derivativeVariance(int order) const {
    const double scale = factorial(order) / std::pow(half, order);
    return scale * scale * variance[order];
  }
};

SmoothAxis::SmoothAxis(AxisNodes nodes) : m_nodes(std::move(nodes)) {
  m_chord.push_back(0);
  for (std::size_t i = 1; i < m_nodes.position.size(); ++i)
    m_chord.push_back(m_chord.back() + (m_nodes.position[i] - m_nodes.position[i - 1]).norm());
  findHalves();
  findNoise();
  findArcs();
}

/// Half-widths follow the mean radius within one window of the node, so that they change smoothly.
void SmoothAxis::findHalves() {
  const std::size_t count = m_chord.size();
  const double most = 0.5 * m_chord.back();
  for (std::size_t i = 0; i < count; ++i) {
    const double reach = kSmoothingRadii * m_nodes.radius[i];
    double sum = 0, weights = 0;
    for (std::size_t k = i; k < count && m_chord[k] - m_chord[i] < reach; ++k) {
      const double w = biweight((m_chord[k] - m_chord[i]) / reach);
      sum += w * m_nodes.radius[k], weights += w;
    }
    for (std::size_t k = i; k-- > 0 && m_chord[i] - m_chord[k] < reach;) {
      const double w = biweight((m_chord[k] - m_chord[i]) / reach);
      sum += w * m_nodes.radius[k], weights += w;
    }
    // few nodes: as many as the fit needs
    const std::size_t side = kFewestNodes / 2 + 1;
    const double enough = std::min(i >= side ? m_chord[i] - m_chord[i - side] : 0,
                                   i + side < count ? m_chord[i + side] - m_chord[i] : 0);
    m_half.push_back(std::max(std::min(std::max(kSmoothingRadii * sum / weights, enough), most),
                              std::numeric_limits<double>::min()));
  }
}

double SmoothAxis::halfAt(double chord, double& cut) const {
  const auto next = std::upper_bound(m_chord.begin() + 1, m_chord.end() - 1, chord);
  const auto i = static_cast<std::size_t>(next - m_chord.begin());
  const double span = m_chord[i] - m_chord[i - 1];
  const double u = span > 0 ? std::clamp((chord - m_chord[i - 1]) / span, 0.0, 1.0) : 0;
  const double half = (1 - u) * m_half[i - 1] + u * m_half[i];
  const double missing = std::max({0.0, half - chord, half - (m_chord.back() - chord)});
  cut = std::min(1.0, missing / half);
  // sparse nodes: a line needs two of them, so the window reaches the second nearest
  const double left = chord - m_chord[i - 1], right = m_chord[i] - chord;
  double second = std::max(left, right);
  if (i > 1) second = std::min(second, std::max(left, chord - m_chord[i - 2]));
  if (i + 1 < m_chord.size()) second = std::min(second, std::max(right, m_chord[i + 1] - chord));
  const double whole = half + std::min(missing, half);
  return whole < second ? second * (1 + kWindowRim) : whole;
}

SmoothAxis::Fit SmoothAxis::fitAt(double chord) const {
  Fit fit;
  fit.half = halfAt(chord, fit.cut);
  const auto first = std::lower_bound(m_chord.begin(), m_chord.end(), chord - fit.half);
  const auto last = std::upper_bound(first, m_chord.end(), chord + fit.half);
  const auto count = static_cast<int>(last - first);
  fit.terms = std::clamp((count + 1) / 2, 2, kMostTerms);
  Square a = Square::Zero(), b = Square::Zero();
  Eigen::Matrix<double, kMostTerms, 3> right = Eigen::Matrix<double, kMostTerms, 3>::Zero();
  const Vector3d origin = m_nodes.position[static_cast<std::size_t>(first - m_chord.begin())];
  for (auto at = first; at != last; ++at) {
    const double x = (*at - chord) / fit.half;
    // a floor keeps the two nodes at the rims of a short window
    const double w = std::max(biweight(x), 1e-6);
    Coefficients row = Coefficients::Zero();
    double power = 1;
    for (int k = 0; k < fit.terms; ++k, power *= x) row[k] = power;
    const Coefficients weighted = w * row;
    a.noalias() += weighted * row.transpose();
    b.noalias() += weighted * weighted.transpose();
    const auto node = static_cast<std::size_t>(at - m_chord.begin());
    right.noalias() += weighted * (m_nodes.position[node] - origin).transpose();
  }
  for (int k = fit.terms; k < kMostTerms; ++k) a(k, k) = 1;
  const Square inverse = a.llt().solve(Square::Identity());
  fit.coefficient.noalias() = inverse * right;
  fit.variance = (inverse * b * inverse).diagonal();
  fit.leverage = inverse(0, 0);
  fit.coefficient.row(0) += origin.transpose();
  return fit;
}

void SmoothAxis::findNoise() {
  double sum = 0, freedom = 0;
  for (std::size_t i = 0; i < m_chord.size(); ++i) {
    const Fit fit = fitAt(m_chord[i]);
    sum += (fit.coefficient.row(0).transpose() - m_nodes.position[i]).squaredNorm();
    // an error along the axis moves the parameter as well, and leaves no residual
    freedom += 2 * std::max(0.0, 1 - fit.leverage);
  }
  m_sd = freedom > 1 ? std::sqrt(sum / freedom) : 0;
}

AxisPlace SmoothAxis::placeAt(double chord) const {
  const Fit fit = fitAt(chord);
  AxisPlace place;
  place.position = fit.coefficient.row(0).transpose();
  const Vector3d d1 = fit.derivative(1), d2 = fit.derivative(2), d3 = fit.derivative(3);
  const double speed = d1.norm();
  place.tangent = speed > 0 ? Vector3d(d1 / speed) : Vector3d::UnitX();
  const Vector3d across = d1.cross(d2);
  const double area = across.norm();
  place.curvature = speed > 0 ? area / (speed * speed * speed) : 0;
  place.half = fit.half;
  const double variance = m_sd * m_sd * m_nodes.correlated;
  place.positionSd = std::sqrt(variance * fit.variance[0]);
  place.tangentSd = speed > 0 ? std::sqrt(variance * fit.derivativeVariance(1)) / speed : 0;
  place.curvatureSd =
      speed > 0 ? std::sqrt(variance * fit.derivativeVariance(2)) / (speed * speed) : 0;
  place.isWhole = fit.cut <= kWholeShare && fit.terms >= 4;
  place.normal = place.binormal = Vector3d::Zero();
  place.torsion = std::numeric_limits<double>::quiet_NaN();
  double turn = place.curvature * place.curvature;  // w^2
  if (area > 0) {
    place.binormal = across / area;
    place.normal = place.binormal.cross(place.tangent);
    if (place.curvature > kSignificant * place.curvatureSd) {
      place.torsion = across.dot(d3) / (area * area);
      turn += std::min(place.torsion * place.torsion, turn);
      const double own = std::sqrt(variance * fit.derivativeVariance(3)) /
                         (place.curvature * speed * speed * speed);
      place.torsionSd = std::hypot(own, place.torsion * place.curvatureSd / place.curvature);
    }
  }
  const double bend = place.half * place.half * turn;
  const double correction = std::min(kCurvatureLoss * bend * bend, kMostCorrection);
  place.curvatureBias = correction * place.curvature;
  place.torsionBias =
      std::min(kTorsionBias * bend * bend, kMostCorrection) * std::abs(place.torsion);
  place.curvature += correction * place.curvature;
  const auto next = std::upper_bound(m_chord.begin() + 1, m_chord.end() - 1, chord);
  const auto i = static_cast<std::size_t>(next - m_chord.begin());
  const double span = m_chord[i] - m_chord[i - 1];
  const double u = span > 0 ? std::clamp((chord - m_chord[i - 1]) / span, 0.0, 1.0) : 0;
  place.radius = (1 - u) * m_nodes.radius[i - 1] + u * m_nodes.radius[i];
  return place;
}

/// Chords of the curve, each lengthened to the arc of its curvature.
void SmoothAxis::findArcs() {
  AxisPlace before = placeAt(0);
  m_grid.push_back(0);
  m_arc.push_back(0);
  for (std::size_t i = 1; i < m_chord.size(); ++i) {
    const double span = m_chord[i] - m_chord[i - 1];
    if (!(span > 0)) continue;
    const double step = kGridRadii * std::min(m_nodes.radius[i - 1], m_nodes.radius[i]);
    const int pieces = std::clamp(
        static_cast<int>(std::min(std::ceil(span / step), 1.0 * kMostPieces)), 1, kMostPieces);
    for (int k = 1; k <= pieces; ++k) {
      const double chord = m_chord[i - 1] + span * k / pieces;
      AxisPlace place = placeAt(chord);
      const double straight = (place.position - before.position).norm();
      const double bend = 0.5 * (place.curvature + before.curvature) * straight;
      m_grid.push_back(chord);
      m_arc.push_back(m_arc.back() + straight * (1 + std::min(bend * bend, 1.0) / 24));
      before = std::move(place);
    }
  }
}

double SmoothAxis::arcAt(double chord) const {
  const auto next = std::upper_bound(m_grid.begin() + 1, m_grid.end() - 1, chord);
  const auto i = static_cast<std::size_t>(next - m_grid.begin());
  const double u = (chord - m_grid[i - 1]) / (m_grid[i] - m_grid[i - 1]);
  return m_arc[i - 1] + u * (m_arc[i] - m_arc[i - 1]);
}

AxisPlace SmoothAxis::at(double along) const {
  const auto next = std::upper_bound(m_arc.begin() + 1, m_arc.end() - 1, along);
  const auto i = static_cast<std::size_t>(next - m_arc.begin());
  const double span = m_arc[i] - m_arc[i - 1];
  const double u = span > 0 ? std::clamp((along - m_arc[i - 1]) / span, 0.0, 1.0) : 0;
  AxisPlace place = placeAt(m_grid[i - 1] + u * (m_grid[i] - m_grid[i - 1]));
  place.along = along;
  return place;
}

std::size_t SmoothAxis::nodeBefore(double along) const {
  const auto next = std::upper_bound(m_arc.begin() + 1, m_arc.end() - 1, along);
  const auto i = static_cast<std::size_t>(next - m_arc.begin());
  const double span = m_arc[i] - m_arc[i - 1];
  const double u = span > 0 ? std::clamp((along - m_arc[i - 1]) / span, 0.0, 1.0) : 0;
  const double chord = m_grid[i - 1] + u * (m_grid[i] - m_grid[i - 1]);
  const auto node = std::upper_bound(m_chord.begin(), m_chord.end(), chord);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node - m_chord.begin() - 1));
}

}  // namespace lumen::convert
