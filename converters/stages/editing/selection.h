// SPDX-License-Identifier: Apache-2.0
// Parts of a case by the names of their branches.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

// The result of an edit: the relation of the changed case to the case before.

/// A node that was not in the case before.
constexpr std::uint32_t kNewNode = UINT32_MAX;

struct Change {
  /// The index before of each node of the case as it is now; kNewNode for a new node.
  std::vector<std::uint32_t> before;
  /// Nodes as they are now, ascending, whose models are out of date because walls around them or
  /// their neighbours along the tree have changed: the nodes for refit(). New nodes have no blobs
  /// until then. Empty if the case has no models.
  std::vector<std::uint32_t> stale;
  /// Names of node arrays that were dropped, since their values at new nodes are unknown, and
  /// formats::kMotionName for the motion.
  std::vector<std::string> droppedArrays;
  /// Sentence for people that describes the edit, as the case's "edit" step records it.
  std::string sentence;
};

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
