// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/insertion.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/option_name.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

using formats::BranchKind;
using formats::CenterlineTree;

Eigen::Vector3d centreOf(const CenterlineTree& tree, std::uint32_t node) {
  const formats::Vec3f& c = tree.centre[node];
  return {c.x, c.y, c.z};
}

std::string labelsOf(const CenterlineTree& tree) {
  constexpr std::size_t kNamed = 20;
  std::string text;
  for (std::size_t b = 0; b < std::min(tree.branches.size(), kNamed); ++b)
    text += (b == 0 ? "" : ", ") + formats::printable(tree.branches[b].label);
  const std::size_t more = tree.branches.size() - std::min(tree.branches.size(), kNamed);
  return more == 0 ? text : text + " and " + std::to_string(more) + " more";
}

std::uint32_t branchToEnter(const CenterlineTree& tree, const std::string& label) {
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    const bool isRoot =
        branch.parentNode == formats::kNoParent && branch.kind == BranchKind::Vessel;
    if (branch.nodeCount > 0 && (label.empty() ? isRoot : branch.label == label)) return b;
  }
  if (label.empty()) throw invalidInput("this case has no vessel that an instrument could enter");
  throw Error(ErrorKind::Usage, kOption.insert.shown() + " " + formats::printable(label) +
                                    ": no branch has this label; there is " + labelsOf(tree));
}

/// The nodes from the first one of a branch on, each followed by its widest child in a vessel.
std::vector<std::uint32_t> widestPath(const CenterlineTree& tree, std::uint32_t first) {
  std::vector<std::optional<std::uint32_t>> widest(tree.nodeCount());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const std::int32_t parent = tree.parent[n];
    if (parent < 0) continue;
    const bool isSac = tree.branches[tree.branch[n]].kind == BranchKind::Aneurysm;
    if (isSac && tree.branch[n] != tree.branch[static_cast<std::uint32_t>(parent)]) continue;
    auto& best = widest[static_cast<std::uint32_t>(parent)];
    if (!best || tree.radius[n] > tree.radius[*best]) best = n;
  }
  std::vector<std::uint32_t> path = {first};
  while (widest[path.back()]) path.push_back(*widest[path.back()]);
  return path;
}

}  // namespace

Insertion findInsertion(const CenterlineTree& tree, const std::string& label, double clearance) {
  Insertion result;
  result.branch = branchToEnter(tree, label);
  result.path = widestPath(tree, tree.branches[result.branch].firstNode);
  const auto& path = result.path;
  std::vector<double> along = {0};
  for (std::size_t k = 1; k < path.size(); ++k)
    along.push_back(along.back() + (centreOf(tree, path[k]) - centreOf(tree, path[k - 1])).norm());
  // a vessel ends in front of an instrument, a sac is filled from its inside
  const bool isSac = tree.branches[result.branch].kind == BranchKind::Aneurysm;
  const double end = along.back() + (isSac ? clearance : -tree.radius[path.back()]);

  std::size_t k = 0;
  while (k < path.size() &&
         (along[k] < clearance || along[k] + clearance > end || tree.radius[path[k]] < clearance))
    ++k;
  if (k == path.size())
    throw invalidInput("branch " + formats::printable(tree.branches[result.branch].label) +
                       ": an instrument that is inserted there needs a lumen of " +
                       fixedText(clearance, 2) + " mm radius and some length, and there is none; " +
                       kOption.insert.shown() + " names another branch, " +
                       kOption.instrument.shown() + " a thinner instrument");
  result.node = path[k];
  result.position = centreOf(tree, path[k]);
  result.radius = tree.radius[path[k]];
  result.pathLength = end - along[k];

  // nodes may jitter sideways by a tenth of a radius, so the direction is taken over a whole one
  std::size_t ahead = k;
  while (ahead + 1 < path.size() && along[ahead] - along[k] < result.radius) ++ahead;
  const Eigen::Vector3d step = centreOf(tree, path[ahead]) - result.position;
  if (step.norm() > 0) result.direction = step.normalized();
  return result;
}

Eigen::Quaterniond turnTo(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
}

}  // namespace lumen::convert
