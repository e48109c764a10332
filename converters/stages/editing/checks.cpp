// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/checks.h"

#include "converters/base/error.h"
#include "formats/container/printable.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

void requireIndex(const char* what, std::uint32_t found, std::size_t count) {
  if (found < count) return;
  throw invalidInput("found " + std::string(what) + " " + std::to_string(found) +
                     ", expected one from 0 to " + std::to_string(count - 1));
}

}  // namespace

void requireBranch(const formats::Case& value, std::uint32_t branch) {
  requireIndex("branch", branch, value.tree.branches.size());
}

void requireNode(const formats::Case& value, std::uint32_t node) {
  requireIndex("node", node, value.tree.nodeCount());
}

std::string quoted(const std::string& label) {
  std::string text(1, '"');
  text += formats::printable(label);
  text += '"';
  return text;
}

std::string quoted(const formats::Case& value, std::uint32_t branch) {
  return quoted(value.tree.branches[branch].label);
}

std::string nodeText(const formats::Case& value, std::uint32_t node) {
  const std::uint32_t branch = value.tree.branch[node];
  return "node " + std::to_string(node - value.tree.branches[branch].firstNode + 1) + " of " +
         quoted(value, branch);
}

void requireLabel(const formats::Case& value, const std::string& label, std::uint32_t branch) {
  if (label.empty()) throw invalidInput("the name is empty; expected at least one character");
  if (const auto issue = formats::checkText(label, formats::kMaxNameBytes, "/label"))
    throw invalidInput("the name " + quoted(label.substr(0, formats::kMaxNameBytes)) +
                       " cannot be used: " + issue->message +
                       "; expected at most 255 bytes of UTF-8 without control characters");
  for (std::uint32_t b = 0; b < value.tree.branches.size(); ++b)
    if (b != branch && value.tree.branches[b].label == label)
      throw invalidInput("the name " + quoted(label) +
                         " is that of another branch; expected one that no branch has");
}

}  // namespace lumen::convert
