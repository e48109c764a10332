// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/proposal_joints.h"

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "formats/case/motion.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"
#include "viewer/session/proposals.h"

namespace lumen::viewer {

namespace {

using formats::Case;
using formats::CenterlineTree;
using formats::Vec3f;

constexpr const char* kExtension = "LUMEN_proposal";
constexpr std::uint32_t kComponents = 4;
constexpr double kSamePlace = 1e-3;  // mm: positions of a case are floats

bool isJoined(const formats::NodeArray& array) {
  return array.name == kJoinedArray;
}

/// Adds the links of `found` between nodes that are in `out` now, and those of its joints to nodes
/// of the case, which are the first `known`. `nodeIn`: the index in `out` of each node.
void addLinks(const CenterlineTree& found, const Joints& joints, const CenterlineTree& known,
              const std::vector<std::int64_t>& nodeIn, CenterlineTree& out) {
  const auto add = [&out](std::int64_t a, std::int64_t b) {
    const auto [low, high] = std::minmax(a, b);
    out.links.push_back({static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high)});
  };
  for (const auto& [a, b] : found.links)
    if (nodeIn[a] >= 0 && nodeIn[b] >= 0) add(nodeIn[a], nodeIn[b]);
  for (std::uint32_t node = 0; node < found.nodeCount(); ++node) {
    const bool isRoot = found.parent[node] == formats::kNoParent;  // it is joined as a child
    if (nodeIn[node] < 0 || isRoot) continue;
    if (const auto at = joints.nodeAt(node, known)) add(nodeIn[node], *at);
  }
  std::sort(out.links.begin(), out.links.end());
  out.links.erase(std::unique(out.links.begin(), out.links.end()), out.links.end());
}

/// Makes room for the wall points of new nodes, and drops arrays that have no values for them.
Case readyToGrow(const Case& known, std::vector<std::string>& dropped) {
  Case out = known;
  if (!out.points) out.points.emplace().offset.assign(known.tree.nodeCount() + 1, 0);
  std::erase_if(out.nodeArrays, [&](const formats::NodeArray& array) {
    if (array.name == formats::kOriginArray || array.name == formats::kEditedWallArray ||
        array.name == formats::kSystemArray)
      return false;
    dropped.push_back(array.name);
    return true;
  });
  if (out.motion) dropped.emplace_back(formats::kMotionName);
  out.motion.reset();
  return out;
}

}  // namespace

Joints::Joints(const Case& proposals) : m_at(proposals.tree.nodeCount()) {
  const auto& arrays = proposals.nodeArrays;
  const auto array = std::find_if(arrays.begin(), arrays.end(), isJoined);
  if (array == arrays.end() || array->components != kComponents) return;
  const auto* values = std::get_if<std::vector<float>>(&array->values);
  for (std::size_t n = 0; values != nullptr && n < m_at.size(); ++n) {
    const float* const v = values->data() + kComponents * n;
    if (v[0] != 0) m_at[n] = Vec3f{v[1], v[2], v[3]};
  }
}

void Joints::cutOff(const CenterlineTree& tree, const std::vector<bool>& goes) {
  const auto isGone = [&](std::size_t node) { return goes[tree.branch[node]]; };
  for (const auto& [a, b] : tree.links)
    if (isGone(a) != isGone(b)) set(isGone(a) ? b : a, tree.centre[isGone(a) ? a : b]);
  // a node with both keeps its parent
  for (const formats::Branch& branch : tree.branches)
    if (const auto above = static_cast<std::size_t>(branch.parentNode);
        branch.parentNode != formats::kNoParent && isGone(above) && !isGone(branch.firstNode))
      set(branch.firstNode, tree.centre[above]);
}

std::optional<std::uint32_t> Joints::nodeAt(std::uint32_t node, const CenterlineTree& tree) const {
  if (!m_at[node]) return std::nullopt;
  const Eigen::Vector3d wanted = toEigen(*m_at[node]);
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if ((toEigen(tree.centre[n]) - wanted).norm() < kSamePlace) return n;
  return std::nullopt;
}

void Joints::write(Case& proposals) const {
  remove(proposals);
  std::vector<float> values;
  for (const auto& at : m_at) {
    const Vec3f p = at.value_or(Vec3f{});
    values.insert(values.end(), {at ? 1.0F : 0.0F, p.x, p.y, p.z});
  }
  proposals.nodeArrays.push_back({kJoinedArray, kComponents, "mm", std::move(values)});
  proposals.metadata.extensionsUsed.emplace_back(kExtension);
}

void Joints::remove(Case& value) {
  std::erase_if(value.nodeArrays, isJoined);
  std::erase(value.metadata.extensionsUsed, kExtension);
}

Case withBranches(const Case& known, const Case& found, const std::vector<bool>& chosen,
                  std::set<std::string> taken, std::vector<std::string>& dropped) {
  const Joints joints(found);
  convert::TrackedTree tree = convert::makeTrackedTree(known),
                       more = convert::makeTrackedTree(found);
  std::vector<int> placeOf(chosen.size(), -1);
  std::vector<std::int64_t> nodeIn(found.tree.nodeCount(), -1);
  auto next = static_cast<std::int64_t>(known.tree.nodeCount());
  for (std::uint32_t b = 0; b < chosen.size(); ++b) {
    if (!chosen[b]) continue;
    const formats::Branch& record = found.tree.branches[b];
    convert::TrackedBranch branch = std::move(more.branches[b]);
    if (branch.parentBranch >= 0) {
      branch.parentBranch = placeOf[static_cast<std::size_t>(branch.parentBranch)];
    } else if (const auto at = joints.nodeAt(record.firstNode, known.tree)) {
      branch.parentBranch = static_cast<int>(known.tree.branch[*at]);
      branch.parentNode = static_cast<int>(
          *at - known.tree.branches[static_cast<std::size_t>(branch.parentBranch)].firstNode);
    }
    for (std::uint32_t i = 0; i < record.nodeCount; ++i) nodeIn[record.firstNode + i] = next++;
    placeOf[b] = static_cast<int>(tree.seeds.size());
    convert::SeedBranch seed = std::move(more.seeds[b]);
    seed.label = convert::freeName(seed.label, taken);
    taken.insert(seed.label);
    tree.seeds.push_back(std::move(seed));
    tree.branches.push_back(std::move(branch));
  }
  Case out = readyToGrow(known, dropped);
  convert::appendTracks(tree, out);
  std::vector<formats::VesselSystem> systems = formats::readNodeSystems(out);
  const std::vector<formats::VesselSystem> systemsFound = formats::readNodeSystems(found);
  for (std::size_t n = 0; n < nodeIn.size(); ++n)
    if (nodeIn[n] >= 0) systems[static_cast<std::size_t>(nodeIn[n])] = systemsFound[n];
  formats::setNodeSystems(out, systems);
  addLinks(found.tree, joints, known.tree, nodeIn, out.tree);
  formats::dropDependentChunks(out);
  if (const auto valid = formats::validate(out); !valid)
    throw invalidInput("the accepted vessels break a rule of the format: " + valid.error().text());
  return out;
}

}  // namespace lumen::viewer
