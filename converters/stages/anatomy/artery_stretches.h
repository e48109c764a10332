// SPDX-License-Identifier: Apache-2.0
// Named nodes of a tree as stretches of its branches.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "converters/stages/anatomy/circle_of_willis.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The stretches of nodes that have one name each, in the order of the nodes. `name` and `plausible` have a
/// value for each node; an empty name, and one that is less plausible than kLeastPlausibility, is none. A
/// single node, as where vessels meet, belongs to the longer of the stretches beside it.
std::vector<ArteryStretch> stretchesOf(const formats::CenterlineTree& tree,
                                       std::span<const std::string> name,
                                       std::span<const double> plausible);

}  // namespace lumen::convert
