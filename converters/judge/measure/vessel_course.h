// SPDX-License-Identifier: Apache-2.0
// A vessel sampled along its smoothed axis, with a cross-section at each sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/measure/smooth_axis.h"
#include "converters/judge/measure/wall.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Reason why a tree alone has no sections; its radii are those of its nodes.
inline constexpr std::string_view kNoModels = "the case has no models: fit it first";

/// One sample of a vessel.
struct CourseSample {
  double along = 0;  ///< mm from where the vessel leaves its parent's lumen
  AxisPlace axis;    ///< its `along` counts from the vessel's first node
  std::uint32_t node = 0;
  double radius = 0;               ///< of the inscribed sphere; of the tree without models, mm
  std::optional<Section> section;  ///< none where there is a reason
  std::string_view absent = {};    ///< why there is no section
  double meanSd = 0, placeSd = 0;  ///< of the wall's mean radius and of one place, mm; or NaN
};

/// A vessel: a branch of the tree that is no aneurysm.
struct VesselCourse {
  std::uint32_t branch = 0;
  std::string_view absent = {};      ///< why there is no course
  std::optional<SmoothAxis> axis;    ///< through the branch's nodes
  std::vector<std::uint32_t> nodes;  ///< node of each of the axis' nodes
  double begin = 0;  ///< arc length of the axis where it leaves the parent's lumen, mm
  double gap = 0;    ///< mm from the parent's lumen to the first node, where that lies outside
  double endSd = 0;  ///< standard deviation of where an end lies along the axis, mm
  std::vector<CourseSample> samples;  ///< evenly spaced, both ends included

  [[nodiscard]] double length() const { return gap + axis->length() - begin; }  ///< mm
};

/// The nodes of a branch as a smoothed axis; empty if they are at fewer than two places. `kept`
/// receives the nodes of the axis: those that are a tenth of a radius from the one before, and the last.
std::optional<SmoothAxis> axisOfNodes(const formats::CenterlineTree& tree,
                                      const std::vector<std::uint32_t>& nodes,
                                      std::vector<std::uint32_t>& kept);

/// Samples of an axis at these arc lengths, with sections if there is a wall.
std::vector<CourseSample> sampleCourse(const formats::CenterlineTree& tree,
                                       const VesselCourse& course, const std::vector<double>& along,
                                       const Wall* wall, const WallNoise* noise);

/// The curve of one branch of a valid tree, without samples.
VesselCourse vesselCourse(const formats::CenterlineTree& tree, std::uint32_t branch);

/// All branches of a valid case in their order, each sampled every half of its median radius.
std::vector<VesselCourse> vesselCourses(const formats::Case& source, const Wall* wall,
                                        const WallNoise* noise, const Progress& progress);

}  // namespace lumen::convert
