// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/anatomical_names.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/anatomy/aortic_arch.h"
#include "converters/stages/anatomy/circle_of_willis.h"
#include "converters/stages/editing/edit_request.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

using convert::ArteryStretch;

void cutBeforeNode(formats::Case& value, std::uint32_t node) {
  convert::EditRequest request;
  request.op = "cut";
  request.node = node;
  request.word = "child";
  (void)convert::applyEdit(value, request);
}

/// Length from where its tree begins to a node, mm.
double lengthToNode(const formats::CenterlineTree& tree, std::uint32_t node) {
  double sum = 0;
  for (std::int32_t above = tree.parent[node]; above != formats::kNoParent;
       above = tree.parent[node]) {
    const auto next = static_cast<std::uint32_t>(above);
    sum += (toEigen(tree.centre[node]) - toEigen(tree.centre[next])).norm();
    node = next;
  }
  return sum;
}

std::string freeNameIn(const formats::CenterlineTree& tree, const std::string& name) {
  std::set<std::string> taken;
  for (const formats::Branch& branch : tree.branches) taken.insert(branch.label);
  return convert::freeName(name, taken);
}

}  // namespace

std::vector<ArteryStretch> anatomicalNames(const formats::Case& value, const std::string& name) {
  if (!value.metadata.source)
    throw invalidInput(formats::printable(name) +
                       ": has no source volume; anatomical names need one, which shows where left "
                       "and front are");
  std::vector<ArteryStretch> stretches = convert::nameCircleOfWillis(value.tree);
  for (ArteryStretch& stretch : convert::nameAorticArch(value.tree))
    stretches.push_back(std::move(stretch));
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return stretches;
}

AnatomicallyNamed anatomicallyNamed(formats::Case value, std::span<const ArteryStretch> stretches) {
  std::vector<ArteryStretch> wanted;
  for (const ArteryStretch& stretch : stretches)
    if (convert::isAutomaticName(value.tree.branches[stretch.branch].label))
      wanted.push_back(stretch);
  // a cut leaves the nodes in their order
  for (const ArteryStretch& stretch : wanted)
    for (const std::uint32_t node : {stretch.first, stretch.end}) {
      if (node >= value.tree.nodeCount()) continue;
      if (value.tree.branches[value.tree.branch[node]].firstNode != node)
        cutBeforeNode(value, node);
    }
  std::stable_sort(wanted.begin(), wanted.end(), [&](const auto& a, const auto& b) {
    return lengthToNode(value.tree, a.first) < lengthToNode(value.tree, b.first);
  });
  for (const ArteryStretch& stretch : wanted) {
    convert::EditRequest request;
    request.op = "rename";
    request.branch = value.tree.branch[stretch.first];
    request.word = freeNameIn(value.tree, stretch.name);
    (void)convert::applyEdit(value, request);
  }
  return {std::move(value), wanted.size()};
}

}  // namespace lumen::operations
