// SPDX-License-Identifier: Apache-2.0
// The one length that every answer, page, record and picture states (docs/measures.md, section 2).
#pragma once

#include <cstdint>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Lengths along the smoothed axes of a tree, from where each vessel leaves its parent's lumen; of an
/// aneurysm, and of a vessel whose nodes lie at one place, along its edges. mm.
struct VesselLengths {
  /// By node: the part of its branch from the node before it. Zero within the parent's lumen.
  std::vector<double> edge;
  std::vector<double> branch;  ///< sums over the branch's nodes
  double total = 0;            ///< of all branches
};

/// Lengths of a valid tree. O(n) fits of a curve, on all cores.
VesselLengths vesselLengths(const formats::CenterlineTree& tree);

/// Branches that hang on one another.
struct TreeExtent {
  std::uint32_t root = 0;  ///< its first branch
  std::uint32_t branches = 0;
  double length = 0;  ///< mm, of all its branches
};

/// The trees of a valid case, the longest first.
std::vector<TreeExtent> listTrees(const formats::CenterlineTree& tree,
                                  const VesselLengths& lengths);

}  // namespace lumen::convert
