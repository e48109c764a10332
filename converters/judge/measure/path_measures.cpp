// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_measures.h.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/judge/measure/fork_arm.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

constexpr double kPathStepRadii = 0.5;
constexpr std::string_view kNoFork = "no fork lies on the path";
constexpr std::string_view kAneurysm = "the path leads through an aneurysm";

/// A path's nodes from the inlet to its end.
std::vector<std::uint32_t> pathTo(const CenterlineTree& tree, std::uint32_t branch) {
  std::vector<std::uint32_t> nodes;
  const formats::Branch& last = tree.branches[branch];
  for (auto n = static_cast<std::int32_t>(last.firstNode + last.nodeCount - 1);
       n != formats::kNoParent; n = tree.parent[static_cast<std::size_t>(n)])
    nodes.push_back(static_cast<std::uint32_t>(n));
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

/// Arms of a row of a fork: the take-off of one of its vessels.
const Measured* takeOffOf(const ForkMeasures& fork, std::uint32_t branch) {
  if (fork.larger == branch) return &fork.takeOffLarger;
  if (fork.smaller == branch) return &fork.takeOffSmaller;
  return nullptr;
}

/// A vessel on a path, up to where the path leaves it.
struct Portion {
  const VesselCourse* course;
  double until = 0;  ///< mm along the course
};

class PathWalk {
public:
  PathWalk(const CenterlineTree& tree, const std::vector<VesselCourse>& courses,
           const std::vector<ForkMeasures>& forks, double shared)
      : m_tree(tree), m_courses(courses), m_forks(forks), m_shared(shared) {}

  [[nodiscard]] PathMeasures measure(std::uint32_t end) const {
    PathMeasures out;
    const std::vector<std::uint32_t> nodes = pathTo(m_tree, end);
    out.end = end;
    out.inlet = m_tree.branch[nodes.front()];
    for (const std::uint32_t n : nodes)
      if (out.branches.empty() || out.branches.back() != m_tree.branch[n])
        out.branches.push_back(m_tree.branch[n]);
    if (const std::string_view reason = obstacle(out); !reason.empty()) {
      leaveOut(reason, out);
      return out;
    }
    std::vector<std::uint32_t> kept;
    const std::optional<SmoothAxis> axis = axisOfNodes(m_tree, nodes, kept);
    if (!axis) {
      leaveOut("its nodes are at one place", out);
      return out;
    }
    measureCurve(placesAlong(*axis), 0, endSdOf(out), out);
    measureCalibres(nodes, out);
    meetForks(nodes, out);
    return out;
  }

private:
  [[nodiscard]] std::string_view obstacle(const PathMeasures& path) const {
    for (const std::uint32_t b : path.branches)
      if (m_tree.branches[b].kind == formats::BranchKind::Aneurysm) return kAneurysm;
    return {};
  }

  [[nodiscard]] double endSdOf(const PathMeasures& path) const {
    return std::max(m_courses[path.inlet].endSd, m_courses[path.end].endSd);
  }

  static std::vector<AxisPlace> placesAlong(const SmoothAxis& axis) {
    std::vector<AxisPlace> places{axis.at(0)};
    double along = 0;
    while (along < axis.length()) {
      along = std::min(axis.length(), along + kPathStepRadii * places.back().radius);
      places.push_back(axis.at(along));
    }
    return places;
  }

  /// The vessels of the path, each up to the node where the path leaves it.
  [[nodiscard]] std::vector<Portion> portionsOf(const std::vector<std::uint32_t>& nodes) const {
    std::vector<Portion> portions;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::uint32_t branch = m_tree.branch[nodes[i]];
      if (i + 1 < nodes.size() && m_tree.branch[nodes[i + 1]] == branch) continue;
      const VesselCourse& course = m_courses[branch];
      if (!course.absent.empty()) continue;
      const auto at = std::lower_bound(course.nodes.begin(), course.nodes.end(), nodes[i]);
      const auto index =
          std::min(static_cast<std::size_t>(at - course.nodes.begin()), course.nodes.size() - 1);
      const double until = course.gap + course.axis->alongOf(index) - course.begin;
      if (until > 0) portions.push_back({&course, until});
    }
    return portions;
  }

  void measureCalibres(const std::vector<std::uint32_t>& nodes, PathMeasures& out) const {
    CalibreSums sums;
    for (const Portion& portion : portionsOf(nodes)) sums.add(*portion.course, portion.until);
    sums.finish(endSdOf(out), m_shared, out);
    out.catheter = out.smallestRadius;
    out.catheter.value *= 2 * kFrenchPerMm;
    out.catheter.plusMinus *= 2 * kFrenchPerMm;
  }

  /// The greatest take-off and the greatest loss of calibre at the forks of the path.
  void meetForks(const std::vector<std::uint32_t>& nodes, PathMeasures& out) const {
    std::size_t met = 0;
    out.takeOff = out.calibreStep = notDefined(kNoFork);
    std::string_view takeOffReason, stepReason;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const std::uint32_t taken = m_tree.branch[nodes[i + 1]];
      for (const ForkMeasures& fork : m_forks) {
        const Measured* takeOff = fork.node == nodes[i] ? takeOffOf(fork, taken) : nullptr;
        if (takeOff == nullptr) continue;
        ++met;
        if (!takeOff->absent.empty())
          takeOffReason = takeOff->absent;
        else if (!out.takeOff.absent.empty() || takeOff->value > out.takeOff.value)
          out.takeOff = *takeOff, out.takeOffPlace = fork.place;
        const Measured step = fork.larger == taken ? fork.calibreLarger : fork.calibreSmaller;
        if (!step.absent.empty())
          stepReason = step.absent;
        else if (!out.calibreStep.absent.empty() || step.value < out.calibreStep.value)
          out.calibreStep = step, out.calibreStepPlace = fork.place;
        break;
      }
    }
    out.forks.value = static_cast<double>(met);
    if (!out.takeOff.absent.empty() && !takeOffReason.empty())
      out.takeOff = notDefined(takeOffReason);
    if (!out.calibreStep.absent.empty() && !stepReason.empty())
      out.calibreStep = notDefined(stepReason);
  }

  static void leaveOut(std::string_view reason, PathMeasures& out) {
    for (Measured* m : {&out.length, &out.chord, &out.tortuosity, &out.sumOfAngles,
                        &out.inflectionCount, &out.meanCurvature, &out.greatestCurvature,
                        &out.turns, &out.turning, &out.smallestRadius, &out.meanRadius, &out.volume,
                        &out.wallArea, &out.forks, &out.takeOff, &out.calibreStep, &out.catheter})
      *m = notDefined(reason);
  }

  const CenterlineTree& m_tree;
  const std::vector<VesselCourse>& m_courses;
  const std::vector<ForkMeasures>& m_forks;
  double m_shared;
};

}  // namespace

std::vector<PathMeasures> measurePaths(const CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses,
                                       const std::vector<ForkMeasures>& forks, double shared,
                                       const Progress& progress) {
  const auto children = childrenOfNodes(tree);
  std::vector<std::uint32_t> ends;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    if (branch.kind == formats::BranchKind::Vessel && branch.nodeCount > 0 &&
        children.count(branch.firstNode + branch.nodeCount - 1) == 0)
      ends.push_back(b);
  }
  const PathWalk walk(tree, courses, forks, shared);
  std::vector<PathMeasures> paths(ends.size());
  tbb::parallel_for(std::size_t{0}, ends.size(), [&](std::size_t i) {
    if (!progress.cancelled()) paths[i] = walk.measure(ends[i]);
  });
  progress.check();
  return paths;
}

}  // namespace lumen::convert
