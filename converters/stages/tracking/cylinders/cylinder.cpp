// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/cylinder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

#include "converters/base/simd.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/icosphere.h"
#include "converters/stages/tracking/cylinders/cylinder_equations.h"

namespace lumen::convert {

namespace {

/// mm^2: twice the parallelogram of three points, below which they lie on a line within single
/// precision.
constexpr float kOnALine = 1e-12F;

}  // namespace

void drawTriples(const std::vector<float>& u, const std::vector<float>& v, Random& random,
                 CircleBlock& block) {
  const std::uint64_t count = u.size();
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    // one number gives three indices of 21 bits each
    const std::uint64_t bits = random.next();
    const std::size_t i = ((bits & 0x1fffff) * count) >> 21;
    const std::size_t j = (((bits >> 21) & 0x1fffff) * count) >> 21;
    const std::size_t k = (((bits >> 42) & 0x1fffff) * count) >> 21;
    block.u[t] = u[i];
    block.v[t] = v[i];
    block.au[t] = u[j] - u[i];
    block.av[t] = v[j] - v[i];
    block.bu[t] = u[k] - u[i];
    block.bv[t] = v[k] - v[i];
  }
}

LUMEN_SIMD_CLONES void circlesThrough(CircleBlock& block, float low, float high) {
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    const float au = block.au[t], av = block.av[t], bu = block.bu[t], bv = block.bv[t];
    const float det = 2.0F * (au * bv - av * bu);
    const float a2 = au * au + av * av, b2 = bu * bu + bv * bv;
    const float cu = (bv * a2 - av * b2) / det, cv = (au * b2 - bu * a2) / det;
    const float r2 = cu * cu + cv * cv;
    const float u = block.u[t] + cu, v = block.v[t] + cv;
    // the rays start in the lumen, so a circle that does not hold their origin is another vessel's
    const bool valid = (std::abs(det) >= kOnALine) & (r2 >= low * low) & (r2 <= high * high) &
                       (u * u + v * v <= r2);
    block.u[t] = u;
    block.v[t] = v;
    block.squaredRadius[t] = valid ? r2 : 0.0F;  // a root would keep the loop scalar, for errno
  }
}

LUMEN_SIMD_CLONES int countInBand(const float* u, const float* v, std::size_t count, float centreU,
                                  float centreV, float low2, float high2) {
  int inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float du = u[i] - centreU, dv = v[i] - centreV;
    const float d2 = du * du + dv * dv;
    inside += static_cast<int>(d2 >= low2) & static_cast<int>(d2 <= high2);
  }
  return inside;
}

int countInBandReference(const float* u, const float* v, std::size_t count, float centreU,
                         float centreV, float low2, float high2) {
  int inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float du = u[i] - centreU, dv = v[i] - centreV;
    const float d2 = du * du + dv * dv;
    if (d2 >= low2 && d2 <= high2) ++inside;
  }
  return inside;
}

namespace {

using Eigen::Vector3d;
using Vector5d = Eigen::Matrix<double, 5, 1>;

/// Least radius, in expected ones.
constexpr double kLeastRadius = 0.5;

/// RANSAC trials after which an axis may be given up: three of four good points in ten are drawn
/// with 98 %.
constexpr int kFirstLook = 64;
/// Share of the inliers needed by an axis that its first look must find; with fewer, it is given
/// up.
constexpr double kPromising = 0.75;
/// Chance that three inliers of the best circle were never drawn together when trials end.
constexpr double kMissed = 1e-4;

/// Least squares: rounds that choose inliers anew, and Gauss-Newton steps in each; both converge
/// sooner on all but degenerate sets.
constexpr int kRounds = 3, kSteps = 8;
/// Relative decrease of the squares below which a round has converged.
constexpr double kConverged = 1e-6;
/// Bounds on the refined radius, in radii of the start: a fit that leaves them has moved to another
/// wall.
constexpr double kLeastRefined = 0.5, kMostRefined = 2.0;

/// One Gauss-Newton step for (shift in the plane, tilt, radius), and the mean squared residual
/// before it.
double stepToLeastSquares(const Candidates& points, const std::vector<std::size_t>& inliers,
                          Cylinder& cylinder) {
  const auto [e1, e2] = planeBasis(cylinder.axis);
  CylinderEquations equations;
  equations.normal.setZero();
  equations.right.setZero();
  double squares = 0;
  for (const std::size_t i : inliers) {
    const Vector3d p = points.origin + points.offset(i) - cylinder.centre;
    const double u = p.dot(e1), v = p.dot(e2), w = p.dot(cylinder.axis);
    const double distance = std::hypot(u, v);
    if (distance == 0) continue;
    const double residual = distance - cylinder.radius;
    Vector5d row;
    row << -u / distance, -v / distance, -w * u / distance, -w * v / distance, -1.0;
    equations.normal += row * row.transpose();
    equations.right -= residual * row;
    squares += residual * residual;
  }
  if (const auto step = equations.solve()) {
    cylinder.centre += (*step)[0] * e1 + (*step)[1] * e2;
    cylinder.axis = (cylinder.axis + (*step)[2] * e1 + (*step)[3] * e2).normalized();
    cylinder.radius += (*step)[4];
  }
  return squares / static_cast<double>(inliers.size());
}

/// Trials after which an event of that probability has almost certainly happened; at most `most`.
int trialsFor(double probability, int most) {
  if (probability >= 1) return 1;
  if (probability <= 0) return most;
  const double trials = std::ceil(std::log(kMissed) / std::log1p(-probability));
  return static_cast<int>(std::min<double>(trials, most));
}

/// The candidates' coordinates along e1 and e2, relative to their origin.
void project(const Candidates& points, const Vector3d& e1, const Vector3d& e2,
             CylinderWorkspace& out) {
  const Eigen::Vector3f a = e1.cast<float>(), b = e2.cast<float>();
  out.u.resize(points.count());
  out.v.resize(points.count());
  for (std::size_t i = 0; i < points.count(); ++i) {
    out.u[i] = points.x[i] * a.x() + points.y[i] * a.y() + points.z[i] * a.z();
    out.v[i] = points.x[i] * b.x() + points.y[i] * b.y() + points.z[i] * b.z();
  }
}

struct Circle {
  float u = 0, v = 0, radius = 0;
  int inliers = 0;
};

/// `best`, or the first circle of a block that has the most inliers if those are more.
Circle betterCircle(const CircleBlock& block, const CylinderWorkspace& points, float band,
                    Circle best) {
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    if (block.squaredRadius[t] == 0) continue;
    const float radius = std::sqrt(block.squaredRadius[t]);
    const float inner = radius * (1.0F - band), outer = radius * (1.0F + band);
    const int inliers = countInBand(points.u.data(), points.v.data(), points.u.size(), block.u[t],
                                    block.v[t], inner * inner, outer * outer);
    if (inliers > best.inliers) best = {block.u[t], block.v[t], radius, inliers};
  }
  return best;
}

/// RANSAC over circles through three of the projected points (Yureidini's thesis, algorithm 2), in
/// blocks. Beyond the least number of trials it ends when a circle is accepted, or when three of
/// the best circle's inliers have been drawn with near certainty (Fischler and Bolles, 1981). It
/// ends early where a first look shows that `needed` inliers are out of reach.
Circle bestCircle(const CylinderSearch& search, const CylinderWorkspace& points, double rho,
                  double needed, Random& random) {
  const auto count = static_cast<std::uint32_t>(points.u.size());
  const auto accepted = static_cast<int>(std::ceil(search.acceptedRate * count));
  const auto band = static_cast<float>(search.band);
  const auto low = static_cast<float>(kLeastRadius * rho);
  const auto high = static_cast<float>(kWidest * rho);
  Circle best;
  int enough = search.maxTrials;
  CircleBlock block;
  for (int trial = 0; trial < enough; trial += kCircleBlock) {
    if (trial >= kFirstLook && best.inliers < kPromising * needed) break;
    if (trial >= search.minTrials && best.inliers >= accepted) break;
    drawTriples(points.u, points.v, random, block);
    circlesThrough(block, low, high);
    best = betterCircle(block, points, band, best);
    const double share = best.inliers / static_cast<double>(count);
    enough = std::max(trialsFor(share * share * share, search.maxTrials), search.minTrials);
  }
  return best;
}

/// Gauss-Newton steps on the inliers as they are, until the squares fall no more.
Cylinder leastSquares(const Candidates& points, const std::vector<std::size_t>& inliers,
                      Cylinder cylinder) {
  double last = stepToLeastSquares(points, inliers, cylinder);
  for (int i = 0; i < kSteps; ++i) {
    const double squares = stepToLeastSquares(points, inliers, cylinder);
    if (!(squares < last * (1.0 - kConverged))) break;
    last = squares;
  }
  return cylinder;
}

}  // namespace

CylinderSearch::CylinderSearch(const TrackOptions& options)
    : acceptedRate(options.inlierRate),
      band(options.inlierBand),
      minTrials(options.minTrials),
      maxTrials(options.maxTrials),
      sphere(icosphere(icosphereOrder(2 * options.axes))) {}

Cylinder estimateCylinder(const CylinderSearch& search, const Candidates& points,
                          const ExpectedCylinder& expected, Random& random,
                          CylinderWorkspace& workspace) {
  const auto& [direction, rho, smooth] = expected;
  Cylinder best;
  best.axis = direction;
  if (points.count() < kFewestCandidates) return best;
  const auto count = static_cast<double>(points.count());
  double bestScore = 0;
  for (const Vector3d& axis : axesAround(direction, search.sphere)) {
    const auto [e1, e2] = planeBasis(axis);
    project(points, e1, e2, workspace);
    // on a thin vessel in noise many axes fit as well: a smooth course is likelier than a sharp
    // turn
    const double weight = smooth ? 0.5 * (1.0 + axis.dot(direction)) : 1.0;
    const Circle circle = bestCircle(search, workspace, rho, bestScore / weight * count, random);
    const double rate = circle.inliers / count;
    const double score = rate * weight * (smooth ? radiusLikeness(circle.radius, rho) : 1.0);
    if (score <= bestScore) continue;
    bestScore = score;
    best = {points.origin + static_cast<double>(circle.u) * e1 + static_cast<double>(circle.v) * e2,
            axis, circle.radius, rate};
    if (rate >= search.acceptedRate) break;
  }
  if (best.inlierRate == 0) return best;
  const Cylinder refined = refineCylinder(points, best, search.band, workspace);
  const bool valid = refined.radius >= kLeastRadius * rho && refined.radius <= kWidest * rho &&
                     (points.origin - refined.centre).cross(refined.axis).norm() <= refined.radius;
  return valid ? refined : best;
}

Cylinder refineCylinder(const Candidates& points, const Cylinder& start, double band,
                        CylinderWorkspace& workspace) {
  std::vector<std::size_t>& inliers = workspace.inliers;
  Cylinder current = start;
  findInliers(points, current, band, inliers);
  for (int round = 0; round < kRounds && inliers.size() >= kFewestCandidates; ++round) {
    const Cylinder next = leastSquares(points, inliers, current);
    if (!(next.radius > kLeastRefined * start.radius && next.radius < kMostRefined * start.radius))
      break;
    const std::size_t before = inliers.size();
    findInliers(points, next, band, inliers);
    if (inliers.size() < before) {
      findInliers(points, current, band, inliers);
      break;
    }
    current = next;
    if (inliers.size() == before) break;
  }
  current.inlierRate = static_cast<double>(inliers.size()) /
                       static_cast<double>(std::max<std::size_t>(points.count(), 1));
  if (inliers.empty()) return current;
  workspace.along.clear();
  for (const std::size_t i : inliers)
    workspace.along.push_back(
        (points.origin + points.offset(i) - current.centre).dot(current.axis));
  current.centre += upperMedian(workspace.along) * current.axis;
  return current;
}

void findInliers(const Candidates& points, const Cylinder& cylinder, double band,
                 std::vector<std::size_t>& out) {
  out.clear();
  const double halfWidth = band * cylinder.radius;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Vector3d p = points.origin + points.offset(i) - cylinder.centre;
    const double distance = p.cross(cylinder.axis).norm();
    if (std::abs(distance - cylinder.radius) <= halfWidth) out.push_back(i);
  }
}

}  // namespace lumen::convert
