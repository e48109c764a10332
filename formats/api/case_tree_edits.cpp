// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/case_edit.h that make and remove nodes.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "formats/api/edited_case.h"
#include "formats/case/motion.h"
#include "formats/case/topology.h"
#include "formats/view/limits.h"
#include "lumen/case_edit.h"

namespace lumen::formats::api {
namespace {

Vec3f toVec3f(const float from[3]) {
  return {from[0], from[1], from[2]};
}

Vec3f between(const Vec3f& a, const Vec3f& b) {
  return {b.x - a.x, b.y - a.y, b.z - a.z};
}

double lengthOf(const Vec3f& v) {
  return std::hypot(double(v.x), double(v.y), double(v.z));
}

/// `v` as a unit vector; +z, as of a node that has no neighbours, for a vector of no length.
Vec3f unit(const Vec3f& v) {
  const double length = lengthOf(v);
  if (!(length > 0)) return {0, 0, 1};
  return {float(v.x / length), float(v.y / length), float(v.z / length)};
}

/// Directions and heights of the nodes of a branch from its centres and radii: the direction from
/// the node before to the node behind, and twice the mean length of the edges beside the node.
void deriveShape(CenterlineTree& tree, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < first + count; ++i) {
    const std::size_t before = i > first ? i - 1 : i, behind = i + 1 < first + count ? i + 1 : i;
    tree.direction[i] = unit(between(tree.centre[before], tree.centre[behind]));
    const double edges = lengthOf(between(tree.centre[before], tree.centre[i])) +
                         lengthOf(between(tree.centre[i], tree.centre[behind]));
    tree.height[i] =
        before == behind ? tree.radius[i] : static_cast<float>(2 * edges / double(behind - before));
  }
}

/// Parents and branches of the nodes from the branches, each of which is a chain.
void deriveParents(CenterlineTree& tree) {
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    for (std::uint32_t i = 0; i < branch.nodeCount; ++i) {
      const std::uint32_t node = branch.firstNode + i;
      tree.parent[node] = i == 0 ? branch.parentNode : static_cast<std::int32_t>(node) - 1;
      tree.branch[node] = static_cast<std::uint32_t>(b);
    }
  }
}

void resizeTree(CenterlineTree& tree, std::size_t count) {
  tree.centre.resize(count);
  tree.direction.resize(count);
  tree.radius.resize(count);
  tree.height.resize(count);
  tree.parent.resize(count);
  tree.branch.resize(count);
}

/// The branches of a definition; their counts must sum up to `nodeCount`. Null says why not.
const char* readBranches(const lumen_case_branch* from, std::size_t count, std::size_t nodeCount,
                         std::vector<Branch>& out) {
  std::size_t next = 0;
  for (std::size_t b = 0; b < count; ++b) {
    if (!from[b].label) return "the label of a branch is a null pointer";
    Branch branch;
    branch.label = from[b].label;
    branch.kind = static_cast<BranchKind>(from[b].kind);
    branch.parentNode = from[b].parent_node;
    branch.firstNode = static_cast<std::uint32_t>(next);
    branch.nodeCount = from[b].node_count;
    branch.stopReason = static_cast<StopReason>(from[b].stop);
    if (const float rate = from[b].mean_inlier_rate; rate >= 0) branch.meanInlierRate = rate;
    next += branch.nodeCount;
    out.push_back(std::move(branch));
  }
  return next == nodeCount ? nullptr : "the branches have not as many nodes as there are";
}

void readNodes(const lumen_case_nodes& from, CenterlineTree& tree) {
  resizeTree(tree, from.count);
  for (const Branch& branch : tree.branches)
    for (std::uint32_t i = branch.firstNode; i < branch.firstNode + branch.nodeCount; ++i) {
      tree.centre[i] = toVec3f(from.centre[i]);
      tree.radius[i] = from.radius[i];
    }
  for (const Branch& branch : tree.branches) deriveShape(tree, branch.firstNode, branch.nodeCount);
  for (std::size_t i = 0; i < from.count; ++i) {
    if (from.direction) tree.direction[i] = toVec3f(from.direction[i]);
    if (from.height) tree.height[i] = from.height[i];
  }
  if (from.inlier_rate) tree.inlierRate.assign(from.inlier_rate, from.inlier_rate + from.count);
  for (std::size_t i = 0; i < from.link_count; ++i)
    tree.links.push_back({from.link[i][0], from.link[i][1]});
  deriveParents(tree);
}

/// Appends `count` entries without points or blobs to offsets.
void appendEmpty(std::vector<std::uint32_t>& offset, std::size_t count) {
  offset.insert(offset.end(), count, offset.back());
}

void appendToNodeData(Case& value, std::size_t count) {
  if (!value.tree.inlierRate.empty()) value.tree.inlierRate.resize(value.tree.nodeCount(), 0);
  if (value.points) appendEmpty(value.points->offset, count);
  if (value.models) appendEmpty(value.models->offset, count);
  for (NodeArray& array : value.nodeArrays)
    std::visit([&](auto& list) { list.resize(list.size() + count * array.components); },
               array.values);
}

/// Keeps those entries of an array, of `components` numbers for each node, whose nodes stay.
template <class T>
void keepEntries(std::vector<T>& values, const std::vector<bool>& stays,
                 std::size_t components = 1) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (stays[i / components]) values[to++] = values[i];
  values.resize(to);
}

/// Whether each point or blob belongs to a node that stays; `offset` becomes that of these nodes.
std::vector<bool> keepOwned(std::vector<std::uint32_t>& offset, const std::vector<bool>& stays) {
  std::vector<bool> owned(offset.back());
  std::vector<std::uint32_t> out{0};
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    std::fill(owned.begin() + offset[i], owned.begin() + offset[i + 1], true);
    out.push_back(out.back() + offset[i + 1] - offset[i]);
  }
  offset = std::move(out);
  return owned;
}

void keepNodeData(Case& value, const std::vector<bool>& stays) {
  CenterlineTree& tree = value.tree;
  keepEntries(tree.centre, stays);
  keepEntries(tree.direction, stays);
  keepEntries(tree.radius, stays);
  keepEntries(tree.height, stays);
  keepEntries(tree.inlierRate, stays);
  if (value.points) keepEntries(value.points->position, keepOwned(value.points->offset, stays));
  if (value.models) {
    const std::vector<bool> owned = keepOwned(value.models->offset, stays);
    keepEntries(value.models->centre, owned);
    keepEntries(value.models->width, owned);
  }
  for (NodeArray& array : value.nodeArrays)
    std::visit([&](auto& list) { keepEntries(list, stays, array.components); }, array.values);
}

/// Removes the branches that do not stay, with their nodes.
void keepBranches(Case& value, const std::vector<bool>& branchStays) {
  CenterlineTree& tree = value.tree;
  std::vector<bool> stays(tree.nodeCount());
  std::vector<std::uint32_t> newIndex(tree.nodeCount());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    stays[i] = branchStays[tree.branch[i]];
    newIndex[i] = next;
    next += stays[i] ? 1 : 0;
  }
  std::vector<Branch> branches;
  for (std::size_t b = 0; b < branchStays.size(); ++b) {
    if (!branchStays[b]) continue;
    Branch branch = std::move(tree.branches[b]);
    branch.firstNode = newIndex[branch.firstNode];
    if (branch.parentNode >= 0)
      branch.parentNode =
          static_cast<std::int32_t>(newIndex[static_cast<std::size_t>(branch.parentNode)]);
    branches.push_back(std::move(branch));
  }
  std::erase_if(tree.links, [&](const auto& link) { return !stays[link[0]] || !stays[link[1]]; });
  for (auto& link : tree.links) link = {newIndex[link[0]], newIndex[link[1]]};
  tree.branches = std::move(branches);
  keepNodeData(value, stays);
  keepMotionOf(value.motion, stays, newIndex);
  resizeTree(tree, next);
  deriveParents(tree);
}

}  // namespace
}  // namespace lumen::formats::api

using namespace lumen::formats;
using namespace lumen::formats::api;

extern "C" {

lumen_case_status lumen_case_create(lumen_case** out) noexcept {
  if (out) *out = nullptr;
  return guarded(nullptr, [&] {
    if (!out) return LUMEN_CASE_ERROR_ARGUMENT;
    *out = new lumen_case;
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_set_tree(lumen_case* value, const lumen_case_nodes* nodes,
                                      const lumen_case_branch* branches, size_t branch_count,
                                      lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    if (!nodes || !branches || !nodes->centre || !nodes->radius ||
        (nodes->link_count > 0 && !nodes->link))
      return refuseArgument(fault, "lumen_case_set_tree() was handed a null pointer");
    if (nodes->count == 0 || nodes->count > kMaxNodes || nodes->link_count > kMaxLinks)
      return refuseArgument(fault, "a tree has 1 to 16777216 nodes, and at most 1048576 links");
    CenterlineTree tree;
    if (const char* reason = readBranches(branches, branch_count, nodes->count, tree.branches))
      return refuseArgument(fault, reason);
    readNodes(*nodes, tree);
    edited.tree = std::move(tree);
    edited.points.reset();
    edited.models.reset();
    edited.motion.reset();
    edited.metadata.pointQuantisation.reset();
    edited.nodeArrays.clear();
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_append_branch(lumen_case* value, const char* label,
                                           lumen_case_kind kind, int32_t parent_node, size_t count,
                                           const float (*centre)[3], const float* radius,
                                           lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    if (!label || !centre || !radius)
      return refuseArgument(fault, "lumen_case_append_branch() was handed a null pointer");
    CenterlineTree& tree = edited.tree;
    const std::size_t first = tree.nodeCount();
    if (count == 0 || count > kMaxNodes - first)
      return refuseArgument(fault, "a branch has a node, and a case at most 16777216");
    resizeTree(tree, first + count);
    for (std::size_t i = 0; i < count; ++i) {
      tree.centre[first + i] = toVec3f(centre[i]);
      tree.radius[first + i] = radius[i];
    }
    deriveShape(tree, first, count);
    Branch branch;
    branch.label = label;
    branch.kind = static_cast<BranchKind>(kind);
    branch.parentNode = parent_node;
    branch.firstNode = static_cast<std::uint32_t>(first);
    branch.nodeCount = static_cast<std::uint32_t>(count);
    tree.branches.push_back(std::move(branch));
    deriveParents(tree);
    appendToNodeData(edited, count);
    edited.motion.reset();
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_remove_branch(lumen_case* value, size_t branch,
                                           lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    const CenterlineTree& tree = edited.tree;
    if (branch >= tree.branches.size()) return refuseArgument(fault, "there is no such branch");
    std::vector<bool> stays(tree.branches.size(), true);
    stays[branch] = false;
    // parents come before their children
    for (std::size_t b = branch + 1; b < stays.size(); ++b)
      if (const std::int32_t parent = tree.branches[b].parentNode; parent >= 0)
        stays[b] = stays[tree.branch[static_cast<std::size_t>(parent)]];
    if (std::find(stays.begin(), stays.end(), true) == stays.end())
      return refuseArgument(fault, "no branch would stay");
    keepBranches(edited, stays);
    return LUMEN_CASE_OK;
  });
}

}  // extern "C"
