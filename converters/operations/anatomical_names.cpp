// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/anatomical_names.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/edit_request.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

using convert::ArteryStretch;

/// Whether a label is that of a search: vessel-, numbers and hyphens.
bool isAutomatic(const std::string& label) {
  const std::string prefix = "vessel-";
  return label.starts_with(prefix) &&
         label.find_first_not_of("0123456789-", prefix.size()) == std::string::npos;
}

void cutBeforeNode(formats::Case& value, std::uint32_t node) {
  convert::EditRequest request;
  request.op = "cut";
  request.node = node;
  request.word = "child";
  (void)convert::applyEdit(value, request);
}

double lengthOfStretch(const formats::CenterlineTree& tree, const ArteryStretch& stretch) {
  double sum = 0;
  for (std::uint32_t n = stretch.first + 1; n < stretch.end; ++n)
    sum += (toEigen(tree.centre[n]) - toEigen(tree.centre[n - 1])).norm();
  return sum;
}

/// The name, or the name and the first free number from 2 on.
std::string freeName(const formats::CenterlineTree& tree, const std::string& name) {
  const auto isTaken = [&](const std::string& label) {
    return std::any_of(tree.branches.begin(), tree.branches.end(),
                       [&](const formats::Branch& branch) { return branch.label == label; });
  };
  std::string label = name;
  for (int number = 2; isTaken(label); ++number) label = name + "-" + std::to_string(number);
  return label;
}

}  // namespace

std::vector<ArteryStretch> anatomicalNames(const formats::Case& value, const std::string& name) {
  if (!value.metadata.source)
    throw invalidInput(formats::printable(name) +
                       ": has no source volume; anatomical names need one, which shows where left "
                       "and front are");
  return convert::nameCircleOfWillis(value.tree);
}

AnatomicallyNamed anatomicallyNamed(formats::Case value, std::span<const ArteryStretch> stretches) {
  std::vector<ArteryStretch> wanted;
  for (const ArteryStretch& stretch : stretches)
    if (isAutomatic(value.tree.branches[stretch.branch].label)) wanted.push_back(stretch);
  // a cut leaves the nodes in their order
  for (const ArteryStretch& stretch : wanted)
    for (const std::uint32_t node : {stretch.first, stretch.end}) {
      if (node >= value.tree.nodeCount()) continue;
      if (value.tree.branches[value.tree.branch[node]].firstNode != node)
        cutBeforeNode(value, node);
    }
  std::stable_sort(wanted.begin(), wanted.end(), [&](const auto& a, const auto& b) {
    return lengthOfStretch(value.tree, a) > lengthOfStretch(value.tree, b);
  });
  for (const ArteryStretch& stretch : wanted) {
    convert::EditRequest request;
    request.op = "rename";
    request.branch = value.tree.branch[stretch.first];
    request.word = freeName(value.tree, stretch.name);
    (void)convert::applyEdit(value, request);
  }
  return {std::move(value), wanted.size()};
}

}  // namespace lumen::operations
