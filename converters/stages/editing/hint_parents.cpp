// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/hint_parents.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/checks.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;

bool remarkOn(const std::vector<SeedFailure>& remarks, const std::string& label) {
  return std::any_of(remarks.begin(), remarks.end(),
                     [&](const SeedFailure& one) { return one.label == label; });
}

/// Distance between two branches, from wall to wall, mm.
double gapBetween(const CenterlineTree& tree, std::uint32_t a, std::uint32_t b) {
  double least = std::numeric_limits<double>::infinity();
  const auto endOf = [&](std::uint32_t branch) {
    return tree.branches[branch].firstNode + tree.branches[branch].nodeCount;
  };
  for (std::uint32_t i = tree.branches[a].firstNode; i < endOf(a); ++i)
    for (std::uint32_t j = tree.branches[b].firstNode; j < endOf(b); ++j)
      least = std::min(least, (toEigen(tree.centre[i]) - toEigen(tree.centre[j])).norm() -
                                  double{tree.radius[i]} - double{tree.radius[j]});
  return std::max(0.0, least);
}

}  // namespace

std::optional<std::uint32_t> branchNamed(const CenterlineTree& tree, const std::string& label) {
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    if (tree.branches[b].label == label) return b;
  return std::nullopt;
}

bool hangsOn(const CenterlineTree& tree, std::uint32_t branch, std::uint32_t above) {
  while (branch != above) {
    const std::int32_t parent = tree.branches[branch].parentNode;
    if (parent == formats::kNoParent) return false;
    branch = tree.branch[static_cast<std::size_t>(parent)];
  }
  return true;
}

std::string millimetres(double length) {
  return fixedText(length, 1) + " mm";
}

std::string aboveText(const CenterlineTree& tree, std::uint32_t branch) {
  const std::int32_t above = tree.branches[branch].parentNode;
  return above == formats::kNoParent
             ? "the root"
             : quoted(tree.branches[tree.branch[static_cast<std::size_t>(above)]].label);
}

std::vector<SeedFailure> unkeptParents(const CenterlineTree& tree,
                                       const std::vector<SeedBranch>& hints,
                                       const std::map<std::string, std::string>& holders,
                                       const std::vector<SeedFailure>& known) {
  std::vector<SeedFailure> out;
  for (const SeedBranch& hint : hints) {
    const auto own = branchNamed(tree, hint.label);
    if (!hint.parent || !own || remarkOn(known, hint.label)) continue;
    const auto holder = holders.find(*hint.parent);
    const auto parent = branchNamed(tree, holder == holders.end() ? *hint.parent : holder->second);
    if (parent && hangsOn(tree, *own, *parent)) continue;
    const bool isRoot = tree.branches[*own].parentNode == formats::kNoParent;
    const std::string where =
        isRoot ? "it begins a tree of its own" : "it hangs on " + aboveText(tree, *own);
    std::string why = " names no vessel";
    if (parent)
      why = " ends " + millimetres(gapBetween(tree, *own, *parent)) + " from it, by the walls";
    out.push_back({hint.label, quoted(*hint.parent) + why + "; " + where});
  }
  return out;
}

}  // namespace lumen::convert
