// SPDX-License-Identifier: Apache-2.0
// The motion of a case through a series of volumes (docs/method.md, section 12).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Measurements at the nodes of a tree, smoothed along it.

/// A measured move of a node across its direction; nothing is known along it.
struct MeasuredMove {
  Eigen::Vector3d move = Eigen::Vector3d::Zero();  ///< mm
  Eigen::Vector3d direction;                       ///< unit
  double deviation = 0;                            ///< mm; 0: not measured
};

/// The most likely moves of all nodes, mm, if along each edge they walk at random with a variance of
/// `walk` mm^2 per mm, from zero at a root. Measurements that are far off count little (Cauchy's
/// weights).
std::vector<Eigen::Vector3d> smoothMoves(const formats::CenterlineTree& tree,
                                         const std::vector<MeasuredMove>& measured, double walk);

/// A measured number of a node.
struct MeasuredNumber {
  double value = 0, deviation = 0;  ///< a deviation of 0: not measured
};

/// The most likely numbers of all nodes, as smoothMoves(), with `walk` per mm for each node, and a
/// prior of zero with the standard deviation `spread`.
std::vector<double> smoothNumbers(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredNumber>& measured,
                                  const std::vector<double>& walk, double spread);

struct MotionOptions {
  /// mm, > 0: the longest displacement of a vessel from one phase to the next, along each axis
  double reach = 12;
  bool dark = false;  ///< vessels are darker than their background
};

/// The findings of one phase.
struct PhaseReport {
  double farthest = 0;     ///< mm: longest displacement of a node from its place at rest
  double seen = 0;         ///< share of the length of vessel that the volume shows, 0 to 1
  double correction = 0;   ///< mm: median displacement by the image of the nodes that it determined
  std::size_t fitted = 0;  ///< nodes that the image determined
};

struct TrackedMotion {
  formats::Motion motion;  ///< of all nodes
  std::vector<PhaseReport> phases;
};

/// Reads the volume of a phase.
using PhaseSource = std::function<Volume(std::size_t phase)>;

/// Follows the nodes of `rest` through the phases, one after another, each from where the one before left
/// them. The first phase shows the contrast of each vessel; if it is the volume that the case was tracked
/// in, by the digest and the place in the case, its poses are those at rest. `time`: seconds of the phases, ascending; `period`: seconds, or 0. The result does not depend on
/// the number of threads. Throws Error(InvalidInput) for a phase that shows no vessel of the case, what
/// the source throws, and Error(Cancelled).
TrackedMotion trackMotion(const formats::Case& rest, const std::vector<double>& time, double period,
                          const PhaseSource& read, const MotionOptions& options,
                          Progress& progress);

}  // namespace lumen::convert
