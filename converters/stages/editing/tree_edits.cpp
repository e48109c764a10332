// SPDX-License-Identifier: Apache-2.0
// Edits of edit.h that concern the joins of branches.
#include <algorithm>
#include <cmath>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/editable_case.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::NodeOrigin;
using formats::StopReason;

/// Distance from one node of a bridge to the next, in lesser radii, as in tracking.
constexpr double kSpacing = 0.5;
/// Nodes of one bridge, as of one branch that is tracked: more means that a radius is wrong.
constexpr double kLongestBridge = 20000;

}  // namespace

std::vector<EditableNode> bridge(const EditableNode& from, const EditableNode& to) {
  const Vector3d start = toEigen(from.centre), chord = toEigen(to.centre) - start;
  const double first = std::min(from.radius, to.radius), last = to.radius;
  const double count = std::floor(chord.norm() / (kSpacing * first));
  if (!(count <= kLongestBridge))
    throw invalidInput(
        "the way there is " + std::to_string(std::lround(count * kSpacing)) +
        " radii long, which would take more than 20000 nodes; expected a nearer node");
  std::vector<EditableNode> nodes;
  for (double n = 1; n < count; ++n) {
    EditableNode node;
    node.origin = NodeOrigin::Bridged;
    node.system = to.system;
    node.centre = toVec3f(start + n / count * chord);
    node.direction = toVec3f(chord.normalized());
    node.radius = static_cast<float>(first + (last - first) * n / count);
    node.height = static_cast<float>(2 * kSpacing) * node.radius;
    nodes.push_back(node);
  }
  return nodes;
}

namespace {

/// Drops the bridge from a branch to the node it was joined to. Nodes that carry something else, or
/// that close a loop, stay, and so does the last.
void dropBridge(const EditableCase& edited, EditableBranch& branch) {
  const auto isUsed = [&](std::uint32_t node) {
    return std::any_of(edited.branches.begin(), edited.branches.end(),
                       [&](const EditableBranch& b) { return b.parent == node; }) ||
           std::any_of(edited.links.begin(), edited.links.end(),
                       [&](const auto& link) { return link[0] == node || link[1] == node; });
  };
  auto first = branch.nodes.begin();
  while (first + 1 != branch.nodes.end() && edited.nodes[*first].origin == NodeOrigin::Bridged &&
         !isUsed(*first))
    ++first;
  branch.nodes.erase(branch.nodes.begin(), first);
}

void requireNotBelow(const Case& target, std::uint32_t branch, std::uint32_t node) {
  const auto& tree = target.tree;
  for (std::uint32_t b = tree.branch[node];;) {
    if (b == branch)
      throw invalidInput(quoted(target, branch) + " cannot hang on " + nodeText(target, node) +
                         ", which is part of it or hangs on it; expected a node of another branch");
    if (tree.branches[b].parentNode == formats::kNoParent) return;
    b = tree.branch[static_cast<std::size_t>(tree.branches[b].parentNode)];
  }
}

}  // namespace

Change joinBranch(Case& target, std::uint32_t branch, std::uint32_t node) {
  requireBranch(target, branch);
  requireNode(target, node);
  requireNotBelow(target, branch, node);
  if (target.tree.branches[branch].parentNode == static_cast<std::int32_t>(node))
    throw invalidInput(quoted(target, branch) + " hangs on " + nodeText(target, node) +
                       " already; expected another node");
  EditableCase edited(target);
  EditableBranch& child = edited.branches[branch];
  dropBridge(edited, child);
  const auto between = bridge(edited.nodes[node], edited.nodes[child.nodes.front()]);
  std::vector<std::uint32_t> chain;
  for (const EditableNode& put : between) {
    chain.push_back(static_cast<std::uint32_t>(edited.nodes.size()));
    edited.nodes.push_back(put);
  }
  child.nodes.insert(child.nodes.begin(), chain.begin(), chain.end());
  child.parent = node;
  child.isOther = true;
  return edited.finish(target,
                       "joined " + quoted(target, branch) + " to " + nodeText(target, node));
}

Change reverseBranch(Case& target, std::uint32_t branch) {
  requireBranch(target, branch);
  EditableCase edited(target);
  EditableBranch& turned = edited.branches[branch];
  edited.reverse(turned.nodes);
  turned.record.stopReason = StopReason::Unknown;
  std::string sentence = "reversed " + quoted(target, branch);
  if (turned.parent != kNoNode) sentence += ", which hangs on nothing now";
  turned.parent = kNoNode;
  return edited.finish(target, sentence);
}

Change makeRoot(Case& target, std::uint32_t branch) {
  requireBranch(target, branch);
  if (target.tree.branches[branch].parentNode == formats::kNoParent)
    throw invalidInput(quoted(target, branch) +
                       " is the root of its tree already; to begin at its other end, reverse it");
  EditableCase edited(target);
  std::uint32_t hangOn = kNoNode, leftAt = kNoNode;  // leftAt: the node by which the way leaves
  for (std::uint32_t b = branch; b != UINT32_MAX;) {
    // dividing puts branches behind all others, so that indices stay
    EditableBranch& piece = edited.branches[b];
    const std::uint32_t above = piece.parent, first = piece.nodes.front();
    const auto at = std::find(piece.nodes.begin(), piece.nodes.end(), leftAt);
    piece.parent = hangOn;
    if (at == piece.nodes.end() || at + 1 == piece.nodes.end()) {
      edited.reverse(piece.nodes);
      piece.record.stopReason = StopReason::Unknown;
    } else if (at != piece.nodes.begin()) {
      EditableBranch rest = piece;
      rest.nodes.erase(rest.nodes.begin(), rest.nodes.begin() + (at - piece.nodes.begin()) + 1);
      rest.parent = leftAt;
      piece.nodes.erase(at + 1, piece.nodes.end());
      piece.isOther = rest.isOther = true;
      piece.record.stopReason = StopReason::Unknown;
      edited.reverse(piece.nodes);
      const std::string other = edited.freeLabel(piece.record.label);
      const bool isLonger = edited.measureLength(rest.nodes) > edited.measureLength(piece.nodes);
      (isLonger ? piece : rest).record.label = other;
      edited.branches.push_back(std::move(rest));
    }
    hangOn = first;
    leftAt = above;
    b = above == kNoNode ? UINT32_MAX : edited.branchOf(above);
  }
  return edited.finish(target,
                       "made the end of " + quoted(target, branch) + " the root of its tree");
}

}  // namespace lumen::convert
