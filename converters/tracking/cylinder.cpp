// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/cylinder.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "converters/tracking/circles.h"
#include "converters/tracking/icosphere.h"

namespace lumen::convert {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// One Gauss-Newton step for (shift in the plane, tilt, radius), and the mean squared residual
/// before it.
double stepToLeastSquares(const Candidates& points, const std::vector<std::size_t>& inliers,
                          Cylinder& cylinder) {
  const auto [e1, e2] = planeBasis(cylinder.axis);
  Matrix5d normal = Matrix5d::Zero();
  Vector5d right = Vector5d::Zero();
  double squares = 0;
  for (const std::size_t i : inliers) {
    const Eigen::Vector3d p = points.origin + points.offset(i) - cylinder.centre;
    const double u = p.dot(e1), v = p.dot(e2), w = p.dot(cylinder.axis);
    const double distance = std::hypot(u, v);
    if (distance == 0) continue;
    const double residual = distance - cylinder.radius;
    Vector5d row;
    row << -u / distance, -v / distance, -w * u / distance, -w * v / distance, -1.0;
    normal += row * row.transpose();
    right -= residual * row;
    squares += residual * residual;
  }
  // a short set of points leaves the tilt free: the prior keeps it where it is
  normal.diagonal().array() += 1e-9 * normal.trace();
  const Vector5d step = normal.ldlt().solve(right);
  if (step.allFinite()) {
    cylinder.centre += step[0] * e1 + step[1] * e2;
    cylinder.axis = (cylinder.axis + step[2] * e1 + step[3] * e2).normalized();
    cylinder.radius += step[4];
  }
  return squares / static_cast<double>(inliers.size());
}

constexpr int kFirstLook = 64;  // trials: three of four good points in ten are drawn with 98 %

/// Trials after which an event of that probability has happened with 99.99 %.
int trialsFor(double probability) {
  if (probability >= 1) return 1;
  const double trials = std::log(1e-4) / std::log1p(-std::max(probability, 1e-6));
  return static_cast<int>(std::ceil(trials));
}

/// 1 for equal radii, less the more they differ: a vessel changes its width slowly.
double likeness(double radius, double rho) {
  return radius > 0 ? std::sqrt(std::min(radius / rho, rho / radius)) : 0.0;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::pair<Eigen::Vector3d, Eigen::Vector3d> planeBasis(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d e1 = axis.unitOrthogonal();
  return {e1, axis.cross(e1)};
}

CylinderEstimator::CylinderEstimator(const TrackOptions& options)
    : m_options(options), m_sphere(icosphere(icosphereOrder(2 * options.axes))) {}

void CylinderEstimator::project(const Candidates& points, const Eigen::Vector3d& e1,
                                const Eigen::Vector3d& e2) {
  const Eigen::Vector3f a = e1.cast<float>(), b = e2.cast<float>();
  m_u.resize(points.count());
  m_v.resize(points.count());
  for (std::size_t i = 0; i < points.count(); ++i) {
    m_u[i] = points.x[i] * a.x() + points.y[i] * a.y() + points.z[i] * a.z();
    m_v[i] = points.x[i] * b.x() + points.y[i] * b.y() + points.z[i] * b.z();
  }
}

/// RANSAC over circles through three of the projected points (thesis algorithm 2), in blocks.
/// Beyond the least number of trials it ends when a circle is accepted, or when three of the best
/// circle's inliers have been drawn with near certainty (Fischler and Bolles, 1981). It ends early
/// where a first look says that `needed` inliers are out of reach.
CylinderEstimator::Circle CylinderEstimator::bestCircle(double rho, double needed, Random& random) {
  const auto count = static_cast<std::uint32_t>(m_u.size());
  const auto accepted = static_cast<int>(std::ceil(m_options.inlierRate * count));
  const auto band = static_cast<float>(m_options.inlierBand);
  const auto low = static_cast<float>(0.5 * rho), high = static_cast<float>(1.5 * rho);
  Circle best;
  int enough = m_options.maxTrials;
  CircleBlock block;
  for (int trial = 0; trial < enough; trial += kCircleBlock) {
    if (trial >= kFirstLook && best.inliers < 0.75 * needed) break;
    if (trial >= m_options.minTrials && best.inliers >= accepted) break;
    drawTriples(m_u, m_v, random, block);
    circlesThrough(block, low, high);
    for (std::size_t t = 0; t < kCircleBlock; ++t) {
      const float radius = block.radius[t];
      if (radius == 0) continue;
      const float inner = radius * (1.0F - band), outer = radius * (1.0F + band);
      const int inliers = countInBand(m_u.data(), m_v.data(), count, block.u[t], block.v[t],
                                      inner * inner, outer * outer);
      if (inliers > best.inliers) best = {block.u[t], block.v[t], radius, inliers};
    }
    const double share = best.inliers / static_cast<double>(count);
    enough = std::clamp(trialsFor(share * share * share), m_options.minTrials, m_options.maxTrials);
  }
  return best;
}

Cylinder CylinderEstimator::estimate(const Candidates& points, const Eigen::Vector3d& direction,
                                     double rho, bool smooth, Random& random) {
  Cylinder best;
  best.axis = direction;
  if (points.count() < 8) return best;
  double bestScore = 0;
  for (const Eigen::Vector3d& axis : axesAround(direction, m_sphere)) {
    const auto [e1, e2] = planeBasis(axis);
    project(points, e1, e2);
    // on a thin vessel in noise many axes fit as well: a smooth course is likelier than a sharp
    // turn
    const double weight = smooth ? 0.5 * (1.0 + axis.dot(direction)) : 1.0;
    const auto count = static_cast<double>(points.count());
    const Circle circle = bestCircle(rho, bestScore / weight * count, random);
    const double rate = circle.inliers / count;
    const double score = rate * weight * (smooth ? likeness(circle.radius, rho) : 1.0);
    if (score <= bestScore) continue;
    bestScore = score;
    best = {points.origin + static_cast<double>(circle.u) * e1 + static_cast<double>(circle.v) * e2,
            axis, circle.radius, rate};
    if (rate >= m_options.inlierRate) break;
  }
  if (best.inlierRate == 0) return best;
  const Cylinder refined = refine(points, best);
  const bool valid = refined.radius >= 0.5 * rho && refined.radius <= 1.5 * rho &&
                     (points.origin - refined.centre).cross(refined.axis).norm() <= refined.radius;
  return valid ? refined : best;
}

Cylinder CylinderEstimator::refine(const Candidates& points, const Cylinder& start) {
  Cylinder current = start;
  inliers(points, current, m_inliers);
  for (int round = 0; round < 3 && m_inliers.size() >= 8; ++round) {
    Cylinder next = current;
    double last = stepToLeastSquares(points, m_inliers, next);
    for (int i = 0; i < 8; ++i) {
      const double squares = stepToLeastSquares(points, m_inliers, next);
      if (!(squares < last * (1.0 - 1e-6))) break;
      last = squares;
    }
    if (!(next.radius > 0.5 * start.radius && next.radius < 2.0 * start.radius)) break;
    const std::size_t before = m_inliers.size();
    inliers(points, next, m_inliers);
    if (m_inliers.size() < before) {
      inliers(points, current, m_inliers);
      break;
    }
    current = next;
    if (m_inliers.size() == before) break;
  }
  current.inlierRate = static_cast<double>(m_inliers.size()) /
                       static_cast<double>(std::max<std::size_t>(points.count(), 1));
  if (m_inliers.empty()) return current;
  m_along.clear();
  for (const std::size_t i : m_inliers)
    m_along.push_back((points.origin + points.offset(i) - current.centre).dot(current.axis));
  current.centre += median(m_along) * current.axis;
  return current;
}

void CylinderEstimator::inliers(const Candidates& points, const Cylinder& cylinder,
                                std::vector<std::size_t>& out) const {
  out.clear();
  const double band = m_options.inlierBand * cylinder.radius;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Eigen::Vector3d p = points.origin + points.offset(i) - cylinder.centre;
    const double distance = p.cross(cylinder.axis).norm();
    if (std::abs(distance - cylinder.radius) <= band) out.push_back(i);
  }
}

}  // namespace lumen::convert
