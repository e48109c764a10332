// SPDX-License-Identifier: Apache-2.0
// What an edit has done to a case.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lumen::convert {

/// A node that was not in the case before.
constexpr std::uint32_t kNewNode = UINT32_MAX;

struct Change {
  /// For each node of the case as it is now, its index before; kNewNode for one that was put in.
  std::vector<std::uint32_t> before;
  /// Nodes as they are now, ascending, whose models are out of date, because walls around them or
  /// their neighbours along the tree are others: what refit() is to be asked for. New nodes have no
  /// blobs until then. Empty if the case has no models.
  std::vector<std::uint32_t> stale;
  /// Names of node arrays that were dropped, since nobody knows their values at new nodes.
  std::vector<std::string> droppedArrays;
  /// What was done, for people, as it stands in the case's "edit" step.
  std::string sentence;
};

}  // namespace lumen::convert
