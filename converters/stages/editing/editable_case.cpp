// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/editable_case.h"

#include <algorithm>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/motion.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::Vec3f;

/// The values of an array with `components` values for each node, for the nodes of the editable
/// case.
template <class Value>
std::vector<Value> gathered(const std::vector<Value>& values, std::size_t components,
                            const std::vector<std::uint32_t>& before) {
  std::vector<Value> out;
  out.reserve(before.size() * components);
  for (const std::uint32_t node : before)
    for (std::size_t c = 0; c < components; ++c) out.push_back(values[node * components + c]);
  return out;
}

Vec3f opposite(const Vec3f& v) {
  return {0.0F - v.x, 0.0F - v.y, 0.0F - v.z};  // no negative zeros
}

}  // namespace

/// The nodes of the case to be, in order.
struct EditableCase::Layout {
  std::vector<std::uint32_t> branches, nodes;  ///< old indices in the new order
  std::vector<std::uint32_t> index;            ///< new indices of nodes; kNoNode for dropped ones
  std::vector<std::uint32_t> before;           ///< the index before of each of `nodes`, or kNewNode
};

EditableCase::EditableCase(const Case& value) : links(value.tree.links), m_case(value) {
  const formats::CenterlineTree& tree = value.tree;
  const auto origins = formats::readNodeOrigins(value);
  const auto edited = formats::readEditedWalls(value);
  const auto systems = formats::readNodeSystems(value);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    nodes.push_back({i, tree.centre[i], tree.direction[i], tree.radius[i], tree.height[i],
                     tree.inlierRate.empty() ? 0 : tree.inlierRate[i], origins[i], edited[i],
                     systems[i]});
  for (const formats::Branch& branch : tree.branches) {
    EditableBranch made{branch, kNoNode, {}};
    if (branch.parentNode != formats::kNoParent)
      made.parent = static_cast<std::uint32_t>(branch.parentNode);
    for (std::uint32_t i = 0; i < branch.nodeCount; ++i) made.nodes.push_back(branch.firstNode + i);
    branches.push_back(std::move(made));
  }
}

void EditableCase::reverse(std::vector<std::uint32_t>& chain) {
  std::reverse(chain.begin(), chain.end());
  for (const std::uint32_t node : chain) nodes[node].direction = opposite(nodes[node].direction);
}

double EditableCase::measureLength(const std::vector<std::uint32_t>& chain) const {
  double length = 0;
  for (std::size_t i = 1; i < chain.size(); ++i)
    length += (toEigen(nodes[chain[i]].centre) - toEigen(nodes[chain[i - 1]].centre)).norm();
  return length;
}

std::string EditableCase::freeLabel(const std::string& base) const {
  std::set<std::string> taken{base};
  for (const EditableBranch& branch : branches) taken.insert(branch.record.label);
  return freeName(base, taken);
}

std::string EditableCase::labelOfRest(const std::string& front) {
  if (!isAutomaticName(front)) return freeLabel(front);
  const PieceName first = pieceNameOf(front);
  for (EditableBranch& branch : branches) {
    if (!isAutomaticName(branch.record.label)) continue;
    PieceName piece = pieceNameOf(branch.record.label);
    if (piece.vessel != first.vessel || piece.piece <= first.piece) continue;
    ++piece.piece;
    branch.record.label = piece.text();
  }
  return PieceName{first.vessel, first.piece + 1}.text();
}

EditableCase::Layout EditableCase::layOut() const {
  std::vector<std::uint32_t> owner(nodes.size(), kNoNode);
  for (std::uint32_t b = 0; b < branches.size(); ++b)
    for (const std::uint32_t node : branches[b].nodes) owner[node] = b;
  Layout layout;
  layout.index.assign(nodes.size(), kNoNode);
  std::vector<bool> isPlaced(branches.size(), false);
  for (std::uint32_t b = 0; b < branches.size(); ++b) {
    // the parents of the branch, up to those that are placed
    std::vector<std::uint32_t> due;
    for (std::uint32_t at = b; at != kNoNode && !isPlaced[at];) {
      due.push_back(at);
      isPlaced[at] = true;
      at = branches[at].parent == kNoNode ? kNoNode : owner[branches[at].parent];
    }
    layout.branches.insert(layout.branches.end(), due.rbegin(), due.rend());
  }
  for (const std::uint32_t b : layout.branches)
    for (const std::uint32_t node : branches[b].nodes) {
      layout.index[node] = static_cast<std::uint32_t>(layout.nodes.size());
      layout.nodes.push_back(node);
      layout.before.push_back(nodes[node].before);
    }
  return layout;
}

void EditableCase::writeTree(const Layout& layout, Case& out) const {
  formats::CenterlineTree& tree = out.tree;
  const bool hasRates = !m_case.tree.inlierRate.empty();
  for (const std::uint32_t n : layout.nodes) {
    const EditableNode& node = nodes[n];
    tree.centre.push_back(node.centre);
    tree.direction.push_back(node.direction);
    tree.radius.push_back(node.radius);
    tree.height.push_back(node.height);
    if (hasRates) tree.inlierRate.push_back(node.inlierRate);
  }
  for (const std::uint32_t b : layout.branches) {
    const EditableBranch& from = branches[b];
    formats::Branch branch = from.record;
    branch.firstNode = layout.index[from.nodes.front()];
    branch.nodeCount = static_cast<std::uint32_t>(from.nodes.size());
    branch.parentNode = from.parent == kNoNode
                            ? formats::kNoParent
                            : static_cast<std::int32_t>(layout.index[from.parent]);
    double rates = 0;
    for (const std::uint32_t node : from.nodes) {
      rates += nodes[node].inlierRate;
      const auto at = static_cast<std::int32_t>(layout.index[node]);
      tree.parent.push_back(node == from.nodes.front() ? branch.parentNode : at - 1);
      tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    }
    if (from.isOther && hasRates && branch.meanInlierRate)
      branch.meanInlierRate = static_cast<float>(rates / static_cast<double>(from.nodes.size()));
    tree.branches.push_back(std::move(branch));
  }
}

void EditableCase::writeLinks(const Layout& layout, Case& out) const {
  for (const auto& [a, b] : links) {
    const std::uint32_t first = std::min(layout.index[a], layout.index[b]);
    const std::uint32_t second = std::max(layout.index[a], layout.index[b]);
    if (second == kNoNode || out.tree.parent[second] == static_cast<std::int32_t>(first)) continue;
    out.tree.links.push_back({first, second});
  }
  // links of two vessels that an edit made one may be equal
  std::sort(out.tree.links.begin(), out.tree.links.end());
  out.tree.links.erase(std::unique(out.tree.links.begin(), out.tree.links.end()),
                       out.tree.links.end());
}

std::vector<std::vector<std::uint32_t>> EditableCase::pointsByOwner() const {
  const formats::PointSets& points = *m_case.points;
  std::vector<std::vector<std::uint32_t>> owned(nodes.size());
  for (std::uint32_t node = 0; node + 1 < points.offset.size(); ++node)
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k)
      owned[pointOwner.empty() ? node : pointOwner[k]].push_back(k);
  return owned;
}

void EditableCase::writePoints(const Layout& layout, Case& out) const {
  if (!m_case.points) return;
  const formats::PointSets& points = *m_case.points;
  out.points.emplace();
  out.points->offset.push_back(0);
  const std::vector<Vec3f>& places = pointPosition.empty() ? points.position : pointPosition;
  const std::vector<std::vector<std::uint32_t>> owned = pointsByOwner();
  for (const std::uint32_t node : layout.nodes) {
    for (const std::uint32_t k : owned[node])
      if (isGone.empty() || !isGone[k]) out.points->position.push_back(places[k]);
    out.points->offset.push_back(static_cast<std::uint32_t>(out.points->position.size()));
  }
}

void EditableCase::writeModels(const Layout& layout, Case& out) const {
  if (!m_case.models) return;
  const formats::BlobbyModels& models = *m_case.models;
  out.models.emplace();
  out.models->kernel = models.kernel;
  out.models->kernelParameter = models.kernelParameter;
  out.models->isoLevel = models.isoLevel;
  out.models->offset.push_back(0);
  for (const std::uint32_t node : layout.before) {
    if (node != kNewNode)
      for (std::uint32_t k = models.offset[node]; k < models.offset[node + 1]; ++k) {
        out.models->centre.push_back(models.centre[k]);
        out.models->width.push_back(models.width[k]);
      }
    out.models->offset.push_back(static_cast<std::uint32_t>(out.models->centre.size()));
  }
}

void EditableCase::writeArrays(const Layout& layout, Case& out, Change& change) const {
  const bool hasNew =
      std::find(layout.before.begin(), layout.before.end(), kNewNode) != layout.before.end();
  for (const formats::NodeArray& array : m_case.nodeArrays) {
    if (array.name == formats::kOriginArray || array.name == formats::kEditedWallArray ||
        array.name == formats::kSystemArray)
      continue;
    if (hasNew) {
      change.droppedArrays.push_back(array.name);
      continue;
    }
    formats::NodeArray kept{array.name, array.components, array.unit, {}};
    std::visit(
        [&](const auto& values) {
          kept.values = gathered(values, array.components, layout.before);
        },
        array.values);
    out.nodeArrays.push_back(std::move(kept));
  }
  std::vector<formats::NodeOrigin> origins;
  std::vector<bool> edited;
  std::vector<formats::VesselSystem> systems;
  for (const std::uint32_t node : layout.nodes) {
    origins.push_back(nodes[node].origin);
    edited.push_back(nodes[node].isEdited);
    systems.push_back(nodes[node].system);
  }
  formats::setNodeOrigins(out, origins);
  formats::setEditedWalls(out, edited);
  formats::setNodeSystems(out, systems);
}

void EditableCase::writeMotion(const Layout& layout, Case& out, Change& change) const {
  if (!m_case.motion) return;
  std::vector<bool> stays(m_case.tree.nodeCount(), false);
  std::vector<std::uint32_t> newIndex(m_case.tree.nodeCount(), 0);
  for (std::uint32_t i = 0; i < layout.before.size(); ++i) {
    const std::uint32_t before = layout.before[i];
    if (before == kNewNode || !(out.tree.centre[i] == m_case.tree.centre[before]))
      return change.droppedArrays.emplace_back(formats::kMotionName), void();
    stays[before] = true;
    newIndex[before] = i;
  }
  out.motion = m_case.motion;
  formats::keepMotionOf(out.motion, stays, newIndex);
}

Change EditableCase::finish(Case& target, const std::string& sentence) const {
  const Layout layout = layOut();
  Change change;
  change.before = layout.before;
  change.sentence = sentence;
  Case out;
  out.metadata = m_case.metadata;
  recordEdit(out.metadata, sentence);
  writeTree(layout, out);
  writeLinks(layout, out);
  writePoints(layout, out);
  writeModels(layout, out);
  writeArrays(layout, out, change);
  writeMotion(layout, out, change);
  out.otherChunks = m_case.otherChunks;
  formats::dropDependentChunks(out);
  if (const auto valid = formats::validate(out); !valid)
    throw invalidInput("this cannot be done, as the case would break a rule of the format: " +
                       valid.error().text());
  if (out.models) change.stale = staleNodes(m_case, out, change.before);
  target = std::move(out);
  return change;
}

}  // namespace lumen::convert
