// SPDX-License-Identifier: Apache-2.0
// How far a mesh lies from the wall of the open case.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::viewer {

struct MeshDeviation {
  std::vector<float> distance;  ///< of each point to the wall, mm; negative in the lumen
  // of the absolute distances, each vertex counting once; zeros without points
  double median = 0, percentile90 = 0, greatest = 0;
};

/// Signed distances of points, in mm, to the nearest point of the wall of all vessels together. The
/// models answer, so ends are round. Takes a case with models. Throws Error(InvalidInput) for models
/// that libblob refuses, and Error(Cancelled).
MeshDeviation meshDeviation(const formats::Case& value, std::span<const Eigen::Vector3d> points,
                            Progress& progress);

}  // namespace lumen::viewer
