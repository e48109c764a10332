// SPDX-License-Identifier: Apache-2.0
// Cases of vessels with closed forms: exact nodes and exact models.
#pragma once

#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/stages/phantom/design.h"
#include "formats/case/case.h"

namespace lumen::convert::test {

inline constexpr double kPi = std::numbers::pi;

inline CaseMeasures measuresOf(const formats::Case& value, MeasureOptions options = {}) {
  Progress progress;
  return measureCase(value, options, progress);
}

/// A tube along a curve, s in mm from 0 to `length`.
struct Tube {
  std::string label = "root";
  std::function<Eigen::Vector3d(double)> position;  ///< parametrised by arc length
  std::function<double(double)> radius;             ///< mm at s
  double length = 0;
  int parent = -1;         ///< index of another tube
  double parentAlong = 0;  ///< mm along it
};

/// The tubes as a tree without points or models, with a node about every `spacing` mm.
formats::Case treeOf(const std::vector<Tube>& tubes, double spacing);

/// treeOf() with models whose surface is exact: each node has the cylinder of the radius in its
/// power cell along its direction, and neighbours blend. Between nodes it differs from the tube by the sagitta
/// of a step in a bend, and by a share of the step of the radius.
formats::Case caseOf(const std::vector<Tube>& tubes, double spacing);

/// Adds wall points on the surface of caseOf(), moved outwards by `offset(index of the point)` mm.
void addPoints(formats::Case& value, double voxel,
               const std::function<double(std::size_t)>& offset);

Tube straightTube(const Eigen::Vector3d& from, const Eigen::Vector3d& along, double length,
                  double radius);
Tube helixTube(double helixRadius, double rise, double turns, double radius);
Tube arcTube(double bend, double angle, double radius);

// The design of a phantom as a case: exact nodes and exact wall points, fitted.
/// Every node of the design that lies `spacing` radii after the one before, with the places where
/// rays in even directions meet the wall within 2.4 radii, and fitted models. `voxel`: mm.
formats::Case caseOfDesign(const Design& design, double spacing, double voxel);

}  // namespace lumen::convert::test
