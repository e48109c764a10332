// SPDX-License-Identifier: Apache-2.0
// Edits of edit.h that concern one branch: deleting, cutting, merging, its name and kind.
#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/editable_case.h"
#include "converters/stages/editing/selection.h"
#include "formats/case/enum_names.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::StopReason;

std::string countText(std::size_t count) {
  return count == 1 ? "1 branch" : std::to_string(count) + " branches";
}

}  // namespace

Change deleteBranch(Case& target, std::uint32_t branch, Hanging hanging) {
  requireBranch(target, branch);
  const formats::CenterlineTree& tree = target.tree;
  std::vector<bool> goes(tree.branches.size(), false);
  goes[branch] = true;
  std::size_t hangs = 0;
  for (std::size_t b = branch + 1; b < goes.size(); ++b) {
    const std::int32_t parent = tree.branches[b].parentNode;
    if (parent == formats::kNoParent || !goes[tree.branch[static_cast<std::size_t>(parent)]])
      continue;
    ++hangs;
    goes[b] = hanging == Hanging::Go;
  }
  std::string sentence = "deleted " + quoted(target, branch);
  if (hangs > 0 && hanging == Hanging::Go)
    sentence += " and " + countText(hangs) + " that hung on it";
  else if (hangs > 0)
    sentence += "; " + countText(hangs) + " that hung on it stayed";
  if (std::find(goes.begin(), goes.end(), false) == goes.end())
    throw invalidInput("nothing would be left without " + quoted(target, branch) +
                       (goes.size() > 1 ? " and what hangs on it" : "") +
                       "; expected a case that keeps at least one branch");
  return deleteBranches(target, goes, sentence);
}

Change cutBefore(Case& target, std::uint32_t node, Rest rest, const std::string& label) {
  requireNode(target, node);
  const std::uint32_t branch = target.tree.branch[node];
  if (node == target.tree.branches[branch].firstNode)
    throw invalidInput("a cut before " + nodeText(target, node) +
                       " leaves nothing of it; expected one of its further nodes");
  if (!label.empty()) requireLabel(target, label, UINT32_MAX);
  EditableCase edited(target);
  EditableBranch& front = edited.branches[branch];
  EditableBranch back = front;
  const auto at = static_cast<std::ptrdiff_t>(node - target.tree.branches[branch].firstNode);
  back.nodes.erase(back.nodes.begin(), back.nodes.begin() + at);
  front.nodes.erase(front.nodes.begin() + at, front.nodes.end());
  front.record.stopReason = StopReason::Unknown;
  front.isOther = back.isOther = true;
  back.parent = rest == Rest::Child ? node - 1 : kNoNode;
  back.record.label = label.empty() ? edited.labelOfRest(front.record.label) : label;
  const std::string sentence = "cut " + quoted(target, branch) + " before its node " +
                               std::to_string(at + 1) + "; the rest is " +
                               quoted(back.record.label);
  edited.branches.insert(edited.branches.begin() + branch + 1, std::move(back));
  return edited.finish(target, sentence);
}

Change mergeIntoParent(Case& target, std::uint32_t branch) {
  requireBranch(target, branch);
  const formats::Branch& child = target.tree.branches[branch];
  if (child.parentNode == formats::kNoParent)
    throw invalidInput(quoted(target, branch) +
                       " hangs on no branch that it could be merged into; join it to one first");
  const auto node = static_cast<std::uint32_t>(child.parentNode);
  const std::uint32_t above = target.tree.branch[node];
  const formats::Branch& parent = target.tree.branches[above];
  if (node + 1 != parent.firstNode + parent.nodeCount)
    throw invalidInput(quoted(target, branch) + " hangs on " + nodeText(target, node) +
                       ", which goes on to node " + std::to_string(parent.nodeCount) +
                       "; expected a branch that goes on from the last node: cut the parent behind "
                       "that node, or join the branch to the last one");
  if (child.kind != parent.kind)
    throw invalidInput(quoted(target, branch) + " and " + quoted(target, above) +
                       " are a vessel and an aneurysm; expected two of a kind: change one first");
  EditableCase edited(target);
  EditableBranch& whole = edited.branches[above];
  EditableBranch& rest = edited.branches[branch];
  whole.nodes.insert(whole.nodes.end(), rest.nodes.begin(), rest.nodes.end());
  whole.record.stopReason = rest.record.stopReason;
  whole.isOther = true;
  const std::string sentence =
      "merged " + quoted(target, branch) + " into " + quoted(target, above);
  edited.branches.erase(edited.branches.begin() + branch);
  return edited.finish(target, sentence);
}

Change setKind(Case& target, std::uint32_t branch, formats::BranchKind kind) {
  requireBranch(target, branch);
  const std::string_view name =
      formats::enumName<formats::BranchKind>(formats::kBranchKindNames, kind);
  if (name.empty())
    throw invalidInput("found kind " + std::to_string(static_cast<int>(kind)) +
                       ", expected 0 for a vessel or 1 for an aneurysm");
  EditableCase edited(target);
  edited.branches[branch].record.kind = kind;
  return edited.finish(target, "made " + quoted(target, branch) + " of kind " + std::string(name));
}

Change renameBranch(Case& target, std::uint32_t branch, const std::string& label) {
  requireBranch(target, branch);
  requireLabel(target, label, branch);
  EditableCase edited(target);
  edited.branches[branch].record.label = label;
  return edited.finish(target, "renamed " + quoted(target, branch) + " to " + quoted(label));
}

}  // namespace lumen::convert
