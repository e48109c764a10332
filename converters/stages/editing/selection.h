// SPDX-License-Identifier: Apache-2.0
// Parts of a case by the names of their branches.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Deletes the branches that are marked; what hangs on them stays as trees of its own. At least one
/// has to stay. Costs O(n) for n nodes.
void deleteBranches(formats::Case& target, const std::vector<bool>& goes);

/// Marks of the branches outside of the trees with a named branch.
std::vector<bool> unconnectedWith(const formats::CenterlineTree& tree,
                                  const std::set<std::string>& labels);

}  // namespace lumen::convert
