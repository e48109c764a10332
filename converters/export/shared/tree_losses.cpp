// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/tree_losses.h"

#include <algorithm>
#include <cstddef>

#include "converters/base/text.h"

namespace lumen {

std::vector<std::string> treeLosses(const formats::CenterlineTree& tree) {
  const auto sacs = static_cast<std::size_t>(std::count_if(
      tree.branches.begin(), tree.branches.end(),
      [](const formats::Branch& branch) { return branch.kind == formats::BranchKind::Aneurysm; }));
  std::vector<std::string> losses;
  if (!tree.links.empty())
    losses.push_back(
        "a centerline file holds trees, so " +
        counted(tree.links.size(), "link that closes a loop is", "links that close loops are") +
        " left out");
  if (sacs > 0)
    losses.push_back("a centerline file holds vessels, so " +
                     counted(sacs, "aneurysm becomes one", "aneurysms become vessels"));
  return losses;
}

}  // namespace lumen
