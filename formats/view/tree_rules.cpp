// SPDX-License-Identifier: Apache-2.0
// Parents, branches and links.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "formats/view/limits.h"
#include "formats/view/model_rules.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

Issue parentIssue(std::int32_t parent, std::size_t node) {
  const std::string found = std::to_string(parent), limit = std::to_string(node);
  return pointerIssue(ErrorCode::NodeParent, at("/tree/parent", node),
                      "found " + found + ", expected -1 or a node before " + limit,
                      {{"found", found}, {"limit", limit}});
}

void checkParents(std::span<const std::int32_t> parents, IssueList& issues) {
  for (std::size_t i = 0; i < parents.size() && !issues.done(); ++i)
    if (parents[i] < -1 || parents[i] >= static_cast<std::int64_t>(i))
      issues.add(ErrorCode::NodeParent, [&] { return parentIssue(parents[i], i); });
}

void checkBranchValues(const BranchView& branch, std::string_view label, const std::string& pointer,
                       IssueList& issues) {
  if (label.empty())
    issues.add({ErrorCode::LabelEmpty, std::nullopt, "the label is empty", {}, pointer + "/label"});
  checkText(label, kMaxNameBytes, pointer + "/label", issues);
  if (branch.kind >= kBranchKindCount)
    issues.add(foundIssue(ErrorCode::EnumValue, pointer + "/kind", std::to_string(branch.kind),
                          "a kind from 0 to 1"));
  if (branch.stopReason >= kStopReasonCount)
    issues.add(foundIssue(ErrorCode::EnumValue, pointer + "/stopReason",
                          std::to_string(branch.stopReason), "a stop reason from 0 to 6"));
  const float rate = branch.meanInlierRate;
  if (rate == kNoRate) return;
  if (!std::isfinite(rate) || rate < 0 || rate > 1)
    issues.add(foundIssue(std::isfinite(rate) ? ErrorCode::InlierRateRange : ErrorCode::NotFinite,
                          pointer + "/meanInlierRate", shortText(rate), "a rate from 0 to 1"));
}

void checkBranchNodes(const CaseView& view, std::size_t index, const BranchView& branch,
                      IssueList& issues) {
  for (std::size_t k = 0; k < branch.nodeCount && !issues.done(); ++k) {
    const std::size_t node = branch.firstNode + k;
    if (view.nodeBranch[node] != index)
      issues.add(ErrorCode::NodeBranch, [&] {
        return foundIssue(ErrorCode::NodeBranch, at("/tree/branch", node),
                          std::to_string(view.nodeBranch[node]),
                          std::to_string(index) + ", the branch that holds the node");
      });
    if (k > 0 && view.nodeParent[node] != static_cast<std::int64_t>(node) - 1)
      issues.add(ErrorCode::NodeChain, [&] {
        return foundIssue(
            ErrorCode::NodeChain, at("/tree/parent", node), std::to_string(view.nodeParent[node]),
            std::to_string(node - 1) + ", the node before in branch " + std::to_string(index));
      });
  }
  if (branch.parentNode != view.nodeParent[branch.firstNode])
    issues.add(foundIssue(
        ErrorCode::BranchParent, at("/tree/branches", index) + "/parentNode",
        std::to_string(branch.parentNode),
        std::to_string(view.nodeParent[branch.firstNode]) + ", the parent of the first node"));
}

bool isParent(const CaseView& view, std::uint32_t node, std::uint32_t of) {
  return view.nodeParent[of] >= 0 && static_cast<std::uint32_t>(view.nodeParent[of]) == node;
}

void addLinkIssue(ErrorCode code, const CaseView& view, std::size_t index, const char* what,
                  IssueList& issues) {
  issues.add(code, [&] {
    const auto [a, b] = view.links[index];
    return pointerIssue(code, at("/tree/links", index),
                        "found " + std::to_string(a) + ", " + std::to_string(b) + what);
  });
}

}  // namespace

void checkBranchRules(const CaseView& view, IssueList& issues) {
  checkParents(view.nodeParent, issues);
  const std::string array = "/tree/branches";
  std::unordered_map<std::string_view, std::size_t> labels;
  std::size_t next = 0;
  for (std::size_t b = 0; b < view.branchCount() && !issues.done(); ++b) {
    const BranchView branch = view.branch(b);
    const std::string pointer = at(array, b);
    const std::string_view label = view.label(branch);
    checkBranchValues(branch, label, pointer, issues);
    if (const auto [first, isNew] = labels.emplace(label, b); !isNew && !label.empty())
      issues.add({ErrorCode::LabelDuplicate,
                  std::nullopt,
                  "the label is that of branch " + std::to_string(first->second),
                  {{"found", std::string(label)}},
                  pointer + "/label"});
    if (branch.firstNode != next || branch.nodeCount == 0 ||
        branch.nodeCount > view.nodeCount() - next)
      // later branches depend on it
      return issues.add(foundIssue(
          ErrorCode::BranchRange,
          pointer + (branch.firstNode != next ? "/firstNode" : "/nodeCount"),
          std::to_string(branch.nodeCount) + " nodes from " + std::to_string(branch.firstNode),
          "1 to " + std::to_string(view.nodeCount() - next) + " from " + std::to_string(next)));
    checkBranchNodes(view, b, branch, issues);
    next += branch.nodeCount;
  }
  if (next != view.nodeCount())
    issues.add(foundIssue(ErrorCode::BranchRange, array,
                          "branches of " + std::to_string(next) + " nodes",
                          std::to_string(view.nodeCount())));
}

void checkLinkRules(const CaseView& view, IssueList& issues) {
  if (!checkLimit(view.links.size(), kMaxLinks, "/tree/links", issues)) return;
  for (std::size_t i = 0; i < view.links.size() && !issues.done(); ++i) {
    const auto [a, b] = view.links[i];
    if (a >= view.nodeCount() || b >= view.nodeCount())
      issues.add(ErrorCode::LinkNode, [&, most = std::max(a, b)] {
        return limitIssue(ErrorCode::LinkNode, at("/tree/links", i), most, view.nodeCount() - 1);
      });
    else if (a >= b || (i > 0 && view.links[i - 1] >= view.links[i]))
      addLinkIssue(ErrorCode::LinkOrder, view, i,
                   ", expected a smaller node first, and links in ascending order", issues);
    else if (isParent(view, a, b) || isParent(view, b, a))
      addLinkIssue(ErrorCode::LinkParent, view, i, ", which are a node and its parent already",
                   issues);
  }
}

}  // namespace lumen::formats
