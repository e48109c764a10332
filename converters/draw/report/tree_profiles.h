// SPDX-License-Identifier: Apache-2.0
// Radius and confidence along the vessels of a tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Every branch once: each before those that leave it, these in the order in which they leave it.
/// The tree is valid.
std::vector<std::uint32_t> inTreeOrder(const formats::CenterlineTree& tree);

/// One branch, node by node. Places along it are in mm from where it leaves the lumen of its
/// parent, as of vesselLengths().
struct TreeProfile {
  std::uint32_t branch = 0;       ///< index
  std::uint32_t firstNode = 0;    ///< index of the node of the first entries
  std::vector<double> along;      ///< mm
  std::vector<float> radius;      ///< mm
  std::vector<float> confidence;  ///< inlier rate, 0 to 1; empty if unknown
  std::vector<double> forks;      ///< mm: where branches leave it, ascending
};

/// One profile for each branch, in tree order.
std::vector<TreeProfile> treeProfiles(const formats::CenterlineTree& tree);

/// Indices of the values to draw so that a line through them looks like one through all, in steps
/// of 1 / `steps` of the width: of each step the first, the least, the greatest and the last. All
/// if there are few. `along` ascends, and is as long as `values`.
std::vector<std::size_t> drawnValues(std::span<const double> along, std::span<const float> values,
                                     std::size_t steps);

/// Share of the vessels' length for each confidence.
struct ConfidenceShares {
  std::vector<double> length;  ///< mm with a rate below 0.1, 0.2, ... and up to 1
  double total = 0;            ///< mm
  double mean = 0;             ///< weighted by length
};
/// Shares of a tree that has inlier rates; a node counts with its edge.
ConfidenceShares confidenceShares(const formats::CenterlineTree& tree);

}  // namespace lumen::convert
