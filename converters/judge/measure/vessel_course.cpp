// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/vessel_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr double kStepRadii = 0.5;     // between samples, of the vessel's median radius
constexpr double kLeavingRadii = 0.1;  // step of the search for the parent's wall
constexpr double kMostLeaving = 1000;  // of that search along an axis
constexpr double kNearestRadii = 0.1;  // between nodes of an axis: nearer ones add time alone
constexpr std::size_t kBlock = 16;     // samples whose rays run together
constexpr double kEndSteps = 0.5;      // steps of the nodes by which an end is uncertain
constexpr double kShortest = 1;        // radii: a vessel that is shorter is a stub

constexpr std::string_view kOutside = "the axis lies outside of the lumen";
constexpr std::string_view kOpen = "the cut runs along a vessel";
constexpr std::string_view kMeets = "the cut meets another vessel";

double medianSpacing(const SmoothAxis& axis) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < axis.nodeCount(); ++i)
    spacing.push_back(axis.alongOf(i) - axis.alongOf(i - 1));
  return median(std::move(spacing));
}

double medianRadius(const CenterlineTree& tree, const std::vector<std::uint32_t>& nodes) {
  std::vector<double> radius;
  for (const std::uint32_t n : nodes) radius.push_back(double{tree.radius[n]});
  return median(std::move(radius));
}

/// Arc length where the axis leaves the tube around its parent; its whole length if it never does.
double leavingPlace(const SmoothAxis& axis, const TubeTreeDistance& parent, double radius) {
  const auto isInside = [&](double along) {
    return parent.nearest(axis.at(along).position).distance < 0;
  };
  const double step = std::max(kLeavingRadii * radius, axis.length() / kMostLeaving);
  double inside = 0, outside = 0;
  if (!isInside(0)) return 0;
  for (outside = step; outside < axis.length() && isInside(outside); outside += step)
    inside = outside;
  if (outside >= axis.length()) return axis.length();
  constexpr int kHalvings = 10;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (isInside(middle) ? inside : outside) = middle;
  }
  return outside;
}

void addSection(const CutPlane& plane, const WallRing& ring, const Wall& wall,
                const CenterlineTree& tree, CourseSample& sample) {
  if (!ring.isInside) {
    sample.absent = kOutside;
    sample.radius = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  sample.radius = wall.inscribed(plane, ring);
  const std::uint32_t branch = tree.branch[sample.node];
  const bool meets = std::any_of(ring.node.begin(), ring.node.end(),
                                 [&](std::uint32_t n) { return tree.branch[n] != branch; });
  if (meets || !ring.isClosed) {
    sample.absent = meets ? kMeets : kOpen;
    return;
  }
  sample.section = sectionOf(plane, ring, sample.axis.curvature * sample.axis.normal);
}

}  // namespace

std::optional<SmoothAxis> axisOfNodes(const CenterlineTree& tree,
                                      const std::vector<std::uint32_t>& nodes,
                                      std::vector<std::uint32_t>& kept) {
  AxisNodes axis;
  std::vector<double> height;
  for (const std::uint32_t n : nodes) {
    const Vector3d centre = toEigen(tree.centre[n]);
    const double radius = double{tree.radius[n]};
    if (!axis.position.empty()) {
      const double from = (centre - axis.position.back()).norm();
      const double least = kNearestRadii * std::max(radius, axis.radius.back());
      if (!(from > 0) || (from < least && n != nodes.back())) continue;
    }
    axis.position.push_back(centre);
    axis.radius.push_back(radius);
    height.push_back(double{tree.height[n]});
    kept.push_back(n);
  }
  if (axis.position.size() < 2) return std::nullopt;
  double length = 0;
  for (std::size_t i = 1; i < axis.position.size(); ++i)
    length += (axis.position[i] - axis.position[i - 1]).norm();
  const double spacing = length / static_cast<double>(axis.position.size() - 1);
  axis.correlated = std::max(1.0, median(std::move(height)) / spacing);
  return SmoothAxis(std::move(axis));
}

std::vector<CourseSample> sampleCourse(const CenterlineTree& tree, const VesselCourse& course,
                                       const std::vector<double>& along, const Wall* wall,
                                       const WallNoise* noise) {
  std::vector<CourseSample> samples(along.size());
  const std::size_t blocks = (along.size() + kBlock - 1) / kBlock;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * kBlock, last = std::min(along.size(), first + kBlock);
    std::vector<CutPlane> planes;
    for (std::size_t i = first; i < last; ++i) {
      CourseSample& sample = samples[i];
      sample.axis = course.axis->at(along[i]);
      sample.along = course.gap + along[i] - course.begin;
      sample.node = course.nodes[course.axis->nodeBefore(along[i])];
      sample.radius = sample.axis.radius;
      sample.absent = wall == nullptr ? kNoModels : std::string_view{};
      const double unknown = std::numeric_limits<double>::quiet_NaN();
      sample.meanSd = noise == nullptr ? unknown : noise->ofMean(sample.node);
      sample.placeSd = noise == nullptr ? unknown : noise->ofPlace(sample.node);
      planes.push_back(
          {sample.axis.position, sample.axis.tangent, sample.node, sample.axis.radius});
    }
    if (wall == nullptr) return;
    const std::vector<WallRing> rings = wall->rings(planes);
    for (std::size_t i = first; i < last; ++i)
      addSection(planes[i - first], rings[i - first], *wall, tree, samples[i]);
  });
  return samples;
}

VesselCourse vesselCourse(const CenterlineTree& tree, std::uint32_t index) {
  const formats::Branch& branch = tree.branches[index];
  VesselCourse course;
  course.branch = index;
  if (branch.kind == formats::BranchKind::Aneurysm) {
    course.absent = "an aneurysm is no tube";
    return course;
  }
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < branch.nodeCount; ++n) nodes.push_back(branch.firstNode + n);
  course.axis = axisOfNodes(tree, nodes, course.nodes);
  if (!course.axis) {
    course.absent = "a stub: its nodes are at one place";
    return course;
  }
  const double radius = medianRadius(tree, course.nodes);
  if (branch.parentNode != formats::kNoParent) {
    const auto from = static_cast<std::size_t>(branch.parentNode);
    course.begin = leavingPlace(*course.axis, TubeTreeDistance(tree, tree.branch[from]), radius);
    if (course.begin == 0) course.gap = formats::edgeLength(tree, branch.firstNode);
  }
  if (course.axis->length() - course.begin < kShortest * radius)
    course.absent = "a stub: it is shorter than its radius beyond its parent's lumen";
  const double step = medianSpacing(*course.axis);
  course.endSd = kEndSteps * step;
  return course;
}

std::vector<VesselCourse> vesselCourses(const formats::Case& source, const Wall* wall,
                                        const WallNoise* noise, const Progress& progress) {
  std::vector<VesselCourse> courses(source.tree.branches.size());
  tbb::parallel_for(std::size_t{0}, courses.size(), [&](std::size_t b) {
    if (progress.cancelled()) return;
    VesselCourse course = vesselCourse(source.tree, static_cast<std::uint32_t>(b));
    if (course.absent.empty()) {
      const double step = kStepRadii * medianRadius(source.tree, course.nodes);
      const double length = course.axis->length() - course.begin;
      const auto pieces = static_cast<std::size_t>(std::max(2.0, std::ceil(length / step - 1e-9)));
      std::vector<double> along;
      for (std::size_t i = 0; i <= pieces; ++i)
        along.push_back(course.begin +
                        length * static_cast<double>(i) / static_cast<double>(pieces));
      course.samples = sampleCourse(source.tree, course, along, wall, noise);
    }
    courses[b] = std::move(course);
  });
  progress.check();
  return courses;
}

}  // namespace lumen::convert
