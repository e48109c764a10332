// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/selection.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "converters/base/text.h"
#include "converters/stages/editing/editable_case.h"

namespace lumen::convert {

namespace {

/// The branch on which a branch hangs; itself if it is a root. Parents come before their children.
std::uint32_t above(const formats::CenterlineTree& tree, std::uint32_t branch) {
  const std::int32_t node = tree.branches[branch].parentNode;
  return node == formats::kNoParent ? branch : tree.branch[static_cast<std::size_t>(node)];
}

}  // namespace

Change deleteBranches(formats::Case& target, const std::vector<bool>& goes,
                      const std::string& sentence) {
  EditableCase edited(target);
  std::vector<EditableBranch> kept;
  for (std::uint32_t b = 0; b < edited.branches.size(); ++b) {
    EditableBranch& branch = edited.branches[b];
    if (branch.parent != kNoNode && goes[edited.branchOf(branch.parent)]) branch.parent = kNoNode;
    if (!goes[b]) kept.push_back(std::move(branch));
  }
  edited.branches = std::move(kept);
  return edited.finish(target, sentence);
}

void leaveOutBranches(formats::Case& target, const std::vector<bool>& goes) {
  const auto count = static_cast<std::size_t>(std::count(goes.begin(), goes.end(), true));
  if (count > 0) deleteBranches(target, goes, "left out " + counted(count, "vessel", "vessels"));
}

std::vector<bool> unconnectedWith(const formats::CenterlineTree& tree,
                                  const std::set<std::string>& labels) {
  const std::size_t count = tree.branches.size();
  std::vector<std::uint32_t> root(count);
  std::vector<bool> isKept(count, false), goes(count);
  for (std::uint32_t b = 0; b < count; ++b) {
    const std::uint32_t parent = above(tree, b);
    root[b] = parent == b ? b : root[parent];
    if (labels.contains(tree.branches[b].label)) isKept[root[b]] = true;
  }
  // trees that a link holds together stay together
  for (bool isMore = true; isMore;) {
    isMore = false;
    for (const auto& [i, j] : tree.links) {
      const std::uint32_t a = root[tree.branch[i]], b = root[tree.branch[j]];
      if (isKept[a] == isKept[b]) continue;
      isKept[a] = isKept[b] = isMore = true;
    }
  }
  for (std::size_t b = 0; b < count; ++b) goes[b] = !isKept[root[b]];
  return goes;
}

}  // namespace lumen::convert
