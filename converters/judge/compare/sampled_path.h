// SPDX-License-Identifier: Apache-2.0
// Centerlines sampled at an even, small step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

struct PathSample {
  Eigen::Vector3d position;  ///< mm
  double radius;             ///< mm, interpolated along the centerline
  bool onLink;  ///< sample on the straight link to the parent node; its radius is undefined
};

struct SampledPath {
  std::vector<PathSample> samples;
  double spacing = 0;  ///< mm between samples; 0 for a single one
};

/// The nodes of a branch, joined by straight lines and sampled evenly, at most `step` mm apart,
/// both ends included. `withLink`: the line from the centre of the parent node to the first node
/// comes first.
SampledPath samplePath(const formats::CenterlineTree& tree, std::uint32_t branch, double step,
                       bool withLink);

struct ClosestPoint {
  double distance;    ///< mm; infinity if the path is empty
  double radius;      ///< mm; radius of the path there
  std::size_t index;  ///< index of the sample at or before it
};

/// The point nearest to `point` on the polyline through the samples.
ClosestPoint closestOn(const std::vector<PathSample>& path, const Eigen::Vector3d& point);

/// Pairs (index into `a`, index into `b`): the ordered correspondence of Schaap et al. (2009). It
/// begins with the two first and ends with the two last samples, each pair advances one or both of
/// the paths by one sample, and the sum of the pairs' distances is minimal. (Both may advance at
/// once, so that equal parallel paths are paired straight across and not in a zigzag.) Empty if a
/// path is empty. Memory: one byte for each pair of samples.
std::vector<std::pair<std::uint32_t, std::uint32_t>> correspond(const std::vector<PathSample>& a,
                                                                const std::vector<PathSample>& b);

}  // namespace lumen::convert
