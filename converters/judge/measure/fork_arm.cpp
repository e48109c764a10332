// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/fork_arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr double kReachRadii = 8;    // of the fork: an arm is followed so far
constexpr double kFitRadii = 4;      // of an arm: its vector is fitted over this stretch
constexpr double kCalibreRadii = 4;  // of an arm: its section is looked for within this stretch
constexpr double kSearchRadii = 0.05;
constexpr std::size_t kFewest = 3;
constexpr int kTerms = 3;  // of a parabola

constexpr std::string_view kShort = "an arm is shorter than its radius beyond the fork";
constexpr std::string_view kNoUpstream = "no vessel leads into the fork";
constexpr std::string_view kNoSection = "an arm has no cross-section within four radii";

/// The polyline of an arm's nodes.
struct ArmLine {
  std::vector<Vector3d> point;
  std::vector<double> radius, along;

  ArmLine(const CenterlineTree& tree, const std::vector<std::uint32_t>& nodes) {
    for (const std::uint32_t n : nodes) {
      const Vector3d p = toEigen(tree.centre[n]);
      const double step = point.empty() ? 0 : (p - point.back()).norm();
      if (!point.empty() && !(step > 0)) continue;
      along.push_back(along.empty() ? 0 : along.back() + step);
      point.push_back(p);
      radius.push_back(double{tree.radius[n]});
    }
  }

  [[nodiscard]] double length() const { return along.back(); }
  [[nodiscard]] std::size_t segmentAt(double s) const {
    const auto next = std::upper_bound(along.begin() + 1, along.end() - 1, s);
    return static_cast<std::size_t>(next - along.begin()) - 1;
  }
  [[nodiscard]] double shareAt(std::size_t i, double s) const {
    return std::clamp((s - along[i]) / (along[i + 1] - along[i]), 0.0, 1.0);
  }
  [[nodiscard]] Vector3d at(double s) const {
    const std::size_t i = segmentAt(s);
    const double u = shareAt(i, s);
    return (1 - u) * point[i] + u * point[i + 1];
  }
  [[nodiscard]] double radiusAt(double s) const {
    const std::size_t i = segmentAt(s);
    const double u = shareAt(i, s);
    return (1 - u) * radius[i] + u * radius[i + 1];
  }
};

std::vector<RoundCone> conesOf(const ArmLine& line) {
  std::vector<RoundCone> cones;
  for (std::size_t i = 0; i + 1 < line.point.size(); ++i)
    cones.emplace_back(line.point[i], line.radius[i], line.point[i + 1], line.radius[i + 1]);
  return cones;
}

/// Where the arm leaves the cones of the others; infinite if it never does.
double armBegin(const ArmLine& line, const std::vector<RoundCone>& others) {
  const double step = kSearchRadii * line.radius.back();
  const auto isInside = [&](double s) {
    const Vector3d p = line.at(s);
    return std::any_of(others.begin(), others.end(),
                       [&](const RoundCone& cone) { return cone.distance(p) < 0; });
  };
  for (double s = 0; s < line.length(); s += step)
    if (!isInside(s)) return s;
  return std::numeric_limits<double>::infinity();
}

/// A place that an arm's vector rests on.
struct ArmPoint {
  double along;  ///< mm from the fork
  Vector3d position;
};

/// Arc lengths of a course as distances along an arm from its fork.
class ArmScale {
public:
  ArmScale(const CenterlineTree& tree, const VesselCourse& course, const ArmLine& line,
           const ForkArm& arm)
      : m_sign(arm.isUpstream ? -1 : 1) {
    const std::uint32_t fork = arm.nodes.front();
    const auto at = std::lower_bound(course.nodes.begin(), course.nodes.end(), fork);
    m_origin = tree.branch[fork] == arm.branch
                   ? course.axis->alongOf(static_cast<std::size_t>(at - course.nodes.begin()))
                   : -line.along[1];
  }
  [[nodiscard]] double operator()(const CourseSample& sample) const {
    return (sample.axis.along - m_origin) * m_sign;
  }

private:
  double m_sign, m_origin = 0;
};

/// Centroids of the sections beyond `begin`, or the nodes there where sections are too few.
std::vector<ArmPoint> pointsBeyond(const ArmLine& line, const VesselCourse& course,
                                   const ArmScale& scale, double begin) {
  const double until = begin + kFitRadii * line.radiusAt(begin);
  std::vector<ArmPoint> points;
  for (const CourseSample& sample : course.samples) {
    const double along = scale(sample);
    if (sample.section && along >= begin && along <= until)
      points.push_back({along, sample.section->centroid});
  }
  if (points.size() > kFewest) return points;
  points.clear();
  for (std::size_t i = 0; i < line.point.size(); ++i)
    if (line.along[i] >= begin && (line.along[i] <= until || points.size() <= kFewest))
      points.push_back({line.along[i], line.point[i]});
  return points;
}

/// Fits a parabola to the points beyond `begin` and takes its chord over one sphere.
void fitVector(const std::vector<ArmPoint>& points, double begin, double radius, double noise,
               ForkArm& arm) {
  if (points.size() < kFewest) {
    arm.absent = kShort;
    return;
  }
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  double scale = radius;
  for (const ArmPoint& point : points) scale = std::max(scale, point.along - begin);
  const auto rowAt = [&](double s) {
    const double x = (s - begin) / scale;
    return Vector3d(1, x, x * x);
  };
  for (const ArmPoint& point : points) {
    const Vector3d row = rowAt(point.along);
    a += row * row.transpose();
    right += row * point.position.transpose();
  }
  const Eigen::Matrix3d inverse = a.ldlt().solve(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d coefficient = inverse * right;
  const Vector3d chord = rowAt(begin + radius) - rowAt(begin);
  double rest = 0;
  for (const ArmPoint& point : points)
    rest += (coefficient.transpose() * rowAt(point.along) - point.position).squaredNorm();
  const double freedom = 3.0 * static_cast<double>(points.size() - kTerms);
  const double sd = std::max(freedom > 0 ? std::sqrt(rest / freedom) : 0.0, noise);
  arm.from = coefficient.row(0).transpose();
  arm.vector = coefficient.transpose() * chord;
  arm.angleSd = sd * std::sqrt(chord.dot(inverse * chord)) / arm.vector.norm();
}

/// The nearest sample with a section beyond one sphere.
void findCalibre(const VesselCourse& course, const ArmScale& scale, double begin, double radius,
                 ForkArm& arm) {
  arm.noCalibre = kNoSection;
  const double least = begin + radius;
  double nearest = least + kCalibreRadii * radius;
  for (const CourseSample& sample : course.samples) {
    const double away = scale(sample);
    const bool isTree = sample.absent == kNoModels;
    if (away < least || away > nearest || (!sample.section && !isTree)) continue;
    nearest = away;
    arm.calibre = isTree ? sample.radius : 0.5 * calibreOf(*sample.section);
    arm.calibreSd = sample.meanSd;
    arm.noCalibre = {};
  }
}

}  // namespace

std::map<std::uint32_t, std::vector<std::uint32_t>> childrenOfNodes(const CenterlineTree& tree) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> children;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    if (branch.parentNode != formats::kNoParent && branch.nodeCount > 0 &&
        branch.kind == formats::BranchKind::Vessel)
      children[static_cast<std::uint32_t>(branch.parentNode)].push_back(b);
  }
  return children;
}

std::vector<ForkArm> armsOf(const CenterlineTree& tree, std::uint32_t node,
                            const std::vector<std::uint32_t>& children) {
  std::vector<ForkArm> arms;
  const std::uint32_t own = tree.branch[node];
  const formats::Branch& branch = tree.branches[own];
  const double reach = kReachRadii * double{tree.radius[node]};
  const Vector3d centre = toEigen(tree.centre[node]);
  const auto isNear = [&](std::uint32_t n) {
    return (toEigen(tree.centre[n]) - centre).norm() < reach;
  };
  ForkArm up{own};
  up.isUpstream = true;
  for (std::uint32_t n = node + 1; n-- > branch.firstNode && isNear(n);) up.nodes.push_back(n);
  arms.push_back(std::move(up));
  const auto follow = [&](std::uint32_t index, std::uint32_t first) {
    ForkArm arm{index};
    arm.nodes.push_back(node);
    const formats::Branch& along = tree.branches[index];
    for (std::uint32_t n = first; n < along.firstNode + along.nodeCount && isNear(n); ++n)
      arm.nodes.push_back(n);
    return arm;
  };
  ForkArm on = follow(own, node + 1);
  double length = 0;
  for (std::size_t i = 1; i < on.nodes.size(); ++i)
    length += (toEigen(tree.centre[on.nodes[i]]) - toEigen(tree.centre[on.nodes[i - 1]])).norm();
  if (length > double{tree.radius[node]}) arms.push_back(std::move(on));
  for (const std::uint32_t child : children)
    arms.push_back(follow(child, tree.branches[child].firstNode));
  return arms;
}

void measureArms(const CenterlineTree& tree, const std::vector<VesselCourse>& courses,
                 std::vector<ForkArm>& arms) {
  std::vector<ArmLine> lines;
  std::vector<std::vector<RoundCone>> cones;
  for (const ForkArm& arm : arms) {
    lines.emplace_back(tree, arm.nodes);
    cones.push_back(conesOf(lines.back()));
  }
  for (std::size_t i = 0; i < arms.size(); ++i) {
    ForkArm& arm = arms[i];
    if (lines[i].point.size() < 2) {
      arm.absent = arm.isUpstream ? kNoUpstream : kShort;
      arm.noCalibre = arm.absent;
      continue;
    }
    std::vector<RoundCone> others;
    for (std::size_t k = 0; k < arms.size(); ++k)
      if (k != i) others.insert(others.end(), cones[k].begin(), cones[k].end());
    const double begin = armBegin(lines[i], others);
    if (!(begin < lines[i].length())) {
      arm.absent = arm.noCalibre = kShort;
      continue;
    }
    const VesselCourse& course = courses[arm.branch];
    const double radius = lines[i].radiusAt(begin);
    if (!course.absent.empty() || lines[i].length() - begin < radius) {
      arm.absent = arm.noCalibre = course.absent.empty() ? kShort : course.absent;
      continue;
    }
    const ArmScale scale(tree, course, lines[i], arm);
    fitVector(pointsBeyond(lines[i], course, scale, begin), begin, radius, course.axis->centreSd(),
              arm);
    findCalibre(course, scale, begin, radius, arm);
  }
}

}  // namespace lumen::convert
