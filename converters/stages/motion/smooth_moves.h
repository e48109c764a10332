// SPDX-License-Identifier: Apache-2.0
// Measurements at the nodes of a tree, smoothed along it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

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

/// The same for numbers, with `walk` per mm for each node, and a prior of zero with the standard deviation
/// `spread`.
std::vector<double> smoothNumbers(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredNumber>& measured,
                                  const std::vector<double>& walk, double spread);

}  // namespace lumen::convert
