// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/cylinder_equations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "converters/base/simd.h"
#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

/// Levenberg damping, of the normal matrix' trace.
constexpr double kTraceDamping = 1e-9;

/// Candidates of one pass, whose arrays stay in the first-level cache; a multiple of the lanes.
constexpr std::size_t kPass = 64;
constexpr std::size_t kSumLanes = 4;

// All clones have lanes of this width, so the order of sums is the same in each.
using SumLanes [[gnu::vector_size(8 * kSumLanes)]] = double;

/// A cylinder, in mm about the candidates' origin.
struct Frame {
  std::array<double, 3> e1, e2, axis, shift;  ///< the last from the centre to the origin
  double radius;
};

struct alignas(64) Pass {
  std::array<float, kPass> x, y, z;
  std::array<double, kPass> cosine, sine;  ///< of the direction from the axis to a candidate
  std::array<double, kPass> along, residual, weight;
};

/// Sums over candidates of the weight times the term in the name: c and s are cosine and sine, w is
/// the place along the axis, r the residual.
enum Sum : std::size_t {
  k1,
  kW,
  kWW,
  kCC,
  kWCC,
  kWWCC,
  kCS,
  kWCS,
  kWWCS,
  kC,
  kS,
  kWC,
  kWS,
  kRC,
  kRS,
  kRWC,
  kRWS,
  kR,
  kSums
};

/// Fills the arrays behind x, y and z.
[[gnu::always_inline]] inline void project(const Frame& frame, double reach, std::size_t count,
                                           Pass& pass) {
  const auto [ax, ay, az] = frame.e1;
  const auto [bx, by, bz] = frame.e2;
  const auto [dx, dy, dz] = frame.axis;
  const auto [sx, sy, sz] = frame.shift;
  const double radius = frame.radius, inverseReach = 1 / reach;
#if !defined(__clang__)
#pragma GCC ivdep
#endif
  for (std::size_t i = 0; i < kPass; ++i) {
    const double x = static_cast<double>(pass.x[i]) + sx, y = static_cast<double>(pass.y[i]) + sy,
                 z = static_cast<double>(pass.z[i]) + sz;
    const double u = x * ax + y * ay + z * az, v = x * bx + y * by + z * bz;
    const double distance = std::sqrt(u * u + v * v);
    const double inverse = 1 / (distance > 0 ? distance : 1.0);
    const double residual = distance - radius, share = residual * inverseReach;
    const double tukey = 1 - share * share;
    pass.cosine[i] = u * inverse;
    pass.sine[i] = v * inverse;
    pass.along[i] = x * dx + y * dy + z * dz;
    pass.residual[i] = residual;
    pass.weight[i] = ((tukey > 0) & (distance > 0)) ? tukey * tukey : 0.0;
  }
  for (std::size_t i = count; i < kPass; ++i) pass.weight[i] = 0;
}

[[gnu::always_inline]] inline void load(const double* from, SumLanes& value) {
  value = *reinterpret_cast<const SumLanes*>(from);
}

[[gnu::always_inline]] inline void accumulate(const Pass& pass, std::size_t count,
                                              std::array<SumLanes, kSums>& sums) {
  for (std::size_t i = 0; i < count; i += kSumLanes) {
    SumLanes c, s, w, r, one;
    load(&pass.cosine[i], c);
    load(&pass.sine[i], s);
    load(&pass.along[i], w);
    load(&pass.residual[i], r);
    load(&pass.weight[i], one);
    const SumLanes along = one * w, cosine = one * c, sine = one * s, off = one * r;
    const SumLanes cc = cosine * c, cs = cosine * s, wcc = w * cc, wcs = w * cs;
    const SumLanes rc = off * c, rs = off * s;
    sums[k1] += one;
    sums[kW] += along;
    sums[kWW] += along * w;
    sums[kCC] += cc;
    sums[kWCC] += wcc;
    sums[kWWCC] += w * wcc;
    sums[kCS] += cs;
    sums[kWCS] += wcs;
    sums[kWWCS] += w * wcs;
    sums[kC] += cosine;
    sums[kS] += sine;
    sums[kWC] += w * cosine;
    sums[kWS] += w * sine;
    sums[kRC] += rc;
    sums[kRS] += rs;
    sums[kRWC] += w * rc;
    sums[kRWS] += w * rs;
    sums[kR] += off;
  }
}

LUMEN_SIMD_CLONES
void sumUp(const float* x, const float* y, const float* z, std::size_t count, const Frame& frame,
           double reach, std::array<double, kSums>& out) {
  std::array<SumLanes, kSums> sums{};
  Pass pass;
  for (std::size_t first = 0; first < count; first += kPass) {
    const std::size_t here = std::min(kPass, count - first);
    for (std::size_t i = 0; i < kPass; ++i) {
      const std::size_t at = first + std::min(i, here - 1);
      pass.x[i] = x[at];
      pass.y[i] = y[at];
      pass.z[i] = z[at];
    }
    project(frame, reach, here, pass);
    accumulate(pass, here, sums);
  }
  for (std::size_t k = 0; k < kSums; ++k)
    out[k] = (sums[k][0] + sums[k][2]) + (sums[k][1] + sums[k][3]);
}

std::array<double, 3> arrayOf(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

std::optional<Eigen::Matrix<double, 5, 1>> CylinderEquations::solve() const {
  Eigen::Matrix<double, 5, 5> damped = normal;
  damped.diagonal().array() += kTraceDamping * normal.trace();
  const Eigen::Matrix<double, 5, 1> step = damped.ldlt().solve(right);
  if (!step.allFinite()) return std::nullopt;
  return step;
}

CylinderEquations robustEquations(const Candidates& points, double reach,
                                  const Cylinder& cylinder) {
  CylinderEquations out;
  std::tie(out.e1, out.e2) = planeBasis(cylinder.axis);
  const Frame frame{arrayOf(out.e1), arrayOf(out.e2), arrayOf(cylinder.axis),
                    arrayOf(points.origin - cylinder.centre), cylinder.radius};
  std::array<double, kSums> s{};
  sumUp(points.x.data(), points.y.data(), points.z.data(), points.count(), frame, reach, s);
  // the row of a candidate is -(c, s, w c, w s, 1), and c^2 + s^2 = 1
  out.normal << s[kCC], s[kCS], s[kWCC], s[kWCS], s[kC],              //
      s[kCS], s[k1] - s[kCC], s[kWCS], s[kW] - s[kWCC], s[kS],        //
      s[kWCC], s[kWCS], s[kWWCC], s[kWWCS], s[kWC],                   //
      s[kWCS], s[kW] - s[kWCC], s[kWWCS], s[kWW] - s[kWWCC], s[kWS],  //
      s[kC], s[kS], s[kWC], s[kWS], s[k1];
  out.right << s[kRC], s[kRS], s[kRWC], s[kRWS], s[kR];
  out.weights = s[k1];
  return out;
}

namespace {

using Eigen::Vector3d;

/// Radii that least squares start from, in expected ones: each finds what lies within the first
/// reach of it.
constexpr std::array kStartRadii = {1.0, 0.75, 1.3};
/// Distance from the wall at which a candidate has no weight, in radii: the first, the factor of
/// each later one, and the bound on the last, in bands of inliers.
constexpr double kFirstReach = 0.9, kNarrowing = 0.75, kReachBands = 1.5;
constexpr int kStepsPerReach = 2;
/// Weight of the expected direction, as a share of the candidates' at a radius along the axis: a
/// short set of points leaves the tilt free.
constexpr double kCourseShare = 0.02;
/// The most of a step, in radii: farther away the wall is not as it looks from here.
constexpr double kMostStep = 0.5;

/// Moves a cylinder by one step; false if too few candidates are near its wall.
bool stepRobustly(const Candidates& points, double reach, const Vector3d& course,
                  Cylinder& cylinder) {
  CylinderEquations equations = robustEquations(points, reach, cylinder);
  if (equations.weights < static_cast<double>(kFewestCandidates) / 2) return false;
  const Vector3d &e1 = equations.e1, &e2 = equations.e2;
  const double held = kCourseShare * equations.weights * cylinder.radius * cylinder.radius;
  const Vector3d away = course - cylinder.axis;
  equations.normal(2, 2) += held;
  equations.normal(3, 3) += held;
  equations.right[2] += held * away.dot(e1);
  equations.right[3] += held * away.dot(e2);
  const auto step = equations.solve();
  if (!step) return false;
  const double most = kMostStep * cylinder.radius;
  const double shift = std::hypot((*step)[0], (*step)[1]), scale = shift > most ? most / shift : 1;
  cylinder.centre += scale * ((*step)[0] * e1 + (*step)[1] * e2);
  cylinder.axis = (cylinder.axis + scale * ((*step)[2] * e1 + (*step)[3] * e2)).normalized();
  cylinder.radius += std::clamp((*step)[4], -most, most);
  return true;
}

/// The cylinder to which robust least squares lead; empty if candidates become too few on the way.
std::optional<Cylinder> converged(const Candidates& points, double band, Cylinder cylinder) {
  const Vector3d course = cylinder.axis;
  const double last = kReachBands * band;
  for (double reach = kFirstReach; reach > last; reach *= kNarrowing)
    for (int k = 0; k < kStepsPerReach; ++k)
      if (!stepRobustly(points, reach * cylinder.radius, course, cylinder)) return std::nullopt;
  return cylinder;
}

}  // namespace

Cylinder nearCylinder(const CylinderSearch& search, const Candidates& points,
                      const ExpectedCylinder& expected, CylinderWorkspace& workspace) {
  const auto& [direction, rho, smooth] = expected;
  Cylinder best;
  best.axis = direction;
  if (points.count() < kFewestCandidates) return best;
  double bestScore = 0;
  for (const double start : kStartRadii) {
    const auto found = converged(points, search.band, {points.origin, direction, start * rho, 0});
    if (!found) continue;
    const Cylinder at = refineCylinder(points, *found, search.band, workspace);
    if (at.radius < kLeastOfDepth * rho || at.radius > kMostOfDepth * rho) continue;
    if ((points.origin - at.centre).cross(at.axis).norm() > at.radius) continue;
    const double course = 0.5 * (1.0 + std::abs(at.axis.dot(direction)));
    const double score = at.inlierRate * (smooth ? course * radiusLikeness(at.radius, rho) : 1.0);
    if (score <= bestScore) continue;
    bestScore = score;
    best = at;
    if (at.inlierRate >= search.acceptedRate) break;
  }
  return best;
}

}  // namespace lumen::convert
