// SPDX-License-Identifier: Apache-2.0
// Parts of a case by the names of their branches.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "converters/stages/editing/change.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Deletes the branches that are marked, and records `sentence`; branches that hang on them stay as
/// trees of their own. At least one has to stay. Costs O(n) for n nodes.
Change deleteBranches(formats::Case& target, const std::vector<bool>& goes,
                      const std::string& sentence);

/// Deletes the branches that are marked, and records their number; if none is marked, the case
/// stays as it is.
void leaveOutBranches(formats::Case& target, const std::vector<bool>& goes);

/// Marks of the branches outside of the trees with a named branch.
std::vector<bool> unconnectedWith(const formats::CenterlineTree& tree,
                                  const std::set<std::string>& labels);

}  // namespace lumen::convert
