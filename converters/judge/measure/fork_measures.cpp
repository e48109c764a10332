// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_measures.h.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/judge/measure/fork_arm.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kDegreesOfFork = 180 / std::numbers::pi;
// Sine of the least angle between two sides of the triangle that spans a fork's plane.
constexpr double kLeastTriangle = 0.05;

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Measured angleOf(const Vector3d& a, double sdA, const Vector3d& b, double sdB) {
  return measured(kDegreesOfFork * angleBetween(a, b), kDegreesOfFork * std::hypot(sdA, sdB));
}

/// x with 1 = p^x + q^x, for p, q in (0, 1): the left side falls with x.
double murray(double p, double q) {
  double low = 0, high = 1;
  while (std::pow(p, high) + std::pow(q, high) > 1 && high < 1e6) high *= 2;
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (std::pow(p, middle) + std::pow(q, middle) > 1 ? low : high) = middle;
  }
  return high;
}

void measureCalibres(const ForkArm& in, const ForkArm& large, const ForkArm& small,
                     ForkMeasures& out) {
  const auto relative = [](const ForkArm& arm) { return arm.calibreSd / arm.calibre; };
  if (!large.noCalibre.empty() || !small.noCalibre.empty()) {
    const auto reason = large.noCalibre.empty() ? small.noCalibre : large.noCalibre;
    out.asymmetry = notDefined(reason);
  } else {
    const double p = small.calibre / large.calibre;
    out.asymmetry = measured(p * p, 2 * p * p * std::hypot(relative(large), relative(small)));
  }
  if (!out.asymmetry.absent.empty() || !in.noCalibre.empty()) {
    out.areaRatio = out.murrayExponent = out.calibreLarger = out.calibreSmaller =
        notDefined(in.noCalibre.empty() ? out.asymmetry.absent : in.noCalibre);
    return;
  }
  const double p = large.calibre / in.calibre, q = small.calibre / in.calibre;
  out.calibreLarger = measured(p, p * std::hypot(relative(large), relative(in)));
  out.calibreSmaller = measured(q, q * std::hypot(relative(small), relative(in)));
  out.areaRatio =
      measured(p * p + q * q, 2 * std::hypot(p * p * relative(large), q * q * relative(small),
                                             (p * p + q * q) * relative(in)));
  if (p >= 1 || q >= 1) {
    out.murrayExponent = notDefined("a vessel that leaves the fork is as wide as the one into it");
    return;
  }
  // by the derivatives of p^x + q^x = 1
  const double x = murray(p, q), px = std::pow(p, x), qx = std::pow(q, x);
  const double slope = std::abs(px * std::log(p) + qx * std::log(q));
  out.murrayExponent =
      measured(x, x / slope * std::hypot(px * relative(large), qx * relative(small), relative(in)));
}

/// Angles in the plane through the three places where the arms leave one another, and out of it.
void measurePlane(const ForkArm& in, const ForkArm& large, const ForkArm& small,
                  ForkMeasures& out) {
  const Vector3d a = large.from - in.from, b = small.from - in.from;
  const Vector3d normal = a.cross(b);
  if (!(normal.norm() > kLeastTriangle * a.norm() * b.norm())) {
    out.inPlaneLarger = out.inPlaneSmaller = out.outOfPlaneParent = out.outOfPlaneLarger =
        out.outOfPlaneSmaller = notDefined("its arms begin on one line: there is no plane");
    return;
  }
  out.normal = normal.normalized();
  const auto flat = [&](const Vector3d& v) { return Vector3d(v - out.normal.dot(v) * out.normal); };
  const auto turn = [&](const Vector3d& v, double sign, double sd) {
    const Vector3d from = flat(out.into), to = flat(v);
    const double angle = std::atan2(out.normal.dot(from.cross(to)), from.dot(to));
    return measured(sign * kDegreesOfFork * angle, kDegreesOfFork * std::hypot(sd, in.angleSd));
  };
  const auto lift = [&](const Vector3d& v, double sd) {
    const double sine = std::clamp(out.normal.dot(v.normalized()), -1.0, 1.0);
    return measured(kDegreesOfFork * std::asin(sine), kDegreesOfFork * sd);
  };
  out.inPlaneLarger = turn(out.outLarger, -1, large.angleSd);
  out.inPlaneSmaller = turn(out.outSmaller, 1, small.angleSd);
  out.outOfPlaneParent = lift(out.into, in.angleSd);
  out.outOfPlaneLarger = lift(out.outLarger, large.angleSd);
  out.outOfPlaneSmaller = lift(out.outSmaller, small.angleSd);
}

void measureAngles(const ForkArm& in, const ForkArm& large, const ForkArm& small,
                   ForkMeasures& out) {
  out.into = -in.vector;
  out.outLarger = large.vector;
  out.outSmaller = small.vector;
  const auto angle = [](const Vector3d& u, const ForkArm& a, const Vector3d& v, const ForkArm& b) {
    if (!a.absent.empty() || !b.absent.empty())
      return notDefined(a.absent.empty() ? b.absent : a.absent);
    return angleOf(u, a.angleSd, v, b.angleSd);
  };
  out.angle = angle(out.outLarger, large, out.outSmaller, small);
  out.takeOffLarger = angle(out.into, in, out.outLarger, large);
  out.takeOffSmaller = angle(out.into, in, out.outSmaller, small);
  for (const ForkArm* arm : {&in, &large, &small}) {
    if (arm->absent.empty()) continue;
    out.inPlaneLarger = out.inPlaneSmaller = out.outOfPlaneParent = out.outOfPlaneLarger =
        out.outOfPlaneSmaller = notDefined(arm->absent);
    return;
  }
  measurePlane(in, large, small, out);
}

/// All measures empty for one reason.
void leaveOut(std::string_view reason, ForkMeasures& out) {
  for (Measured* m : {&out.angle, &out.takeOffLarger, &out.takeOffSmaller, &out.inPlaneLarger,
                      &out.inPlaneSmaller, &out.outOfPlaneParent, &out.outOfPlaneLarger,
                      &out.outOfPlaneSmaller, &out.calibreLarger, &out.calibreSmaller,
                      &out.areaRatio, &out.murrayExponent, &out.asymmetry})
    *m = notDefined(reason);
}

}  // namespace

std::vector<ForkMeasures> measureForks(const formats::CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses) {
  std::vector<ForkMeasures> forks;
  for (const auto& [node, children] : childrenOfNodes(tree)) {
    std::vector<ForkArm> arms = armsOf(tree, node, children);
    measureArms(tree, courses, arms);
    for (std::size_t i = 1; i < arms.size(); ++i)
      for (std::size_t k = i + 1; k < arms.size(); ++k) {
        const bool isSwapped = arms[k].calibre > arms[i].calibre;
        const ForkArm &large = arms[isSwapped ? k : i], &small = arms[isSwapped ? i : k];
        ForkMeasures& out = forks.emplace_back();
        out.node = node;
        out.parent = tree.branch[node];
        out.larger = large.branch;
        out.smaller = small.branch;
        out.place = toEigen(tree.centre[node]);
        if (tree.branches[out.parent].kind == formats::BranchKind::Aneurysm) {
          leaveOut("a fork inside an aneurysm", out);
          continue;
        }
        measureAngles(arms.front(), large, small, out);
        measureCalibres(arms.front(), large, small, out);
      }
  }
  return forks;
}

}  // namespace lumen::convert
