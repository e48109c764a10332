// SPDX-License-Identifier: Apache-2.0
// Named nodes of a tree as stretches of its branches.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Names are given from this plausibility on.
constexpr double kLeastPlausibility = 0.7;

/// A stretch of a branch that is a named artery: the nodes [first, end).
struct ArteryStretch {
  std::uint32_t branch = 0, first = 0, end = 0;
  std::string name;         ///< such as R-ICA, BA or aortic_arch
  double plausibility = 0;  ///< 0 to 1: the product over the rules that led to the name
};

/// The stretches of nodes that have one name each, in the order of the nodes. `name` and `plausible` have a
/// value for each node; an empty name, and one that is less plausible than kLeastPlausibility, is none. A
/// single node, as where vessels meet, belongs to the longer of the stretches beside it.
std::vector<ArteryStretch> stretchesOf(const formats::CenterlineTree& tree,
                                       std::span<const std::string> name,
                                       std::span<const double> plausible);

}  // namespace lumen::convert
