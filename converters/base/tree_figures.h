// SPDX-License-Identifier: Apache-2.0
// Figures of a centerline tree, as `lumen info` and records of libraries state them.
#pragma once

#include <algorithm>
#include <span>

#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen {

struct RadiusRange {
  float min = 0, mean = 0, max = 0;  ///< mm
};

/// Range of at least one radius.
inline RadiusRange radiusRange(std::span<const float> radii) {
  double sum = 0;
  for (const float r : radii) sum += static_cast<double>(r);
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  return {*low, static_cast<float>(sum / static_cast<double>(radii.size())), *high};
}

/// Length of all branches, mm.
inline double totalLength(const formats::CenterlineTree& tree) {
  double length = 0;
  for (const auto& branch : tree.branches) length += formats::branchLength(tree, branch);
  return length;
}

}  // namespace lumen
