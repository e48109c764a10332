// SPDX-License-Identifier: Apache-2.0
// Names of the arteries of the circle of Willis, by geometry and topology (docs/method.md, section 13).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Names are given from this plausibility on.
constexpr double kLeastPlausibility = 0.7;

/// A stretch of a branch that is a named artery: the nodes [first, end).
struct ArteryStretch {
  std::uint32_t branch = 0, first = 0, end = 0;
  std::string name;         ///< such as R-ICA, L-Pcom, Acom or BA
  double plausibility = 0;  ///< 0 to 1: the product over the rules that led to the name
};

/// The arteries of the circle of Willis in a tree in mm, LPS, whose inlets are roots: R and L for ICA, MCA, ACA, Pcom and PCA,
/// and Acom and BA, as TopCoW has them (K. Yang et al., "Benchmarking the CoW with the TopCoW challenge",
/// arXiv:2312.17670, 2023), in the order of the nodes. Empty where no pair of carotid arteries with a first
/// segment of an anterior cerebral artery is found; a part whose name is not plausible has none.
std::vector<ArteryStretch> nameCircleOfWillis(const formats::CenterlineTree& tree);

}  // namespace lumen::convert
