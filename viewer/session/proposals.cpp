// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/proposals.h"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include "converters/base/options/edit_steps.h"
#include "converters/base/radius_range.h"
#include "converters/base/text.h"
#include "converters/geometry/automatic_names.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/vessel_length.h"
#include "converters/stages/editing/selection.h"
#include "formats/case/enum_names.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"
#include "viewer/session/proposal_joints.h"

namespace lumen::viewer {

namespace {

using formats::Case;
using formats::CenterlineTree;

/// The branch on which a branch hangs, or -1.
int findParent(const CenterlineTree& tree, const formats::Branch& branch) {
  return branch.parentNode == formats::kNoParent
             ? -1
             : static_cast<int>(tree.branch[static_cast<std::size_t>(branch.parentNode)]);
}

/// Leaves out the marked branches; what is left out is not recorded, as nobody has edited anything.
std::shared_ptr<const Case> without(Case value, const std::vector<bool>& goes) {
  if (std::find(goes.begin(), goes.end(), false) == goes.end()) return nullptr;
  const std::vector<formats::Step> steps = value.metadata.steps;
  convert::leaveOutBranches(value, goes);
  value.metadata.steps = steps;
  return std::make_shared<const Case>(std::move(value));
}

/// Records in a case the label maps that its new vessels were found with (operations::recordMaps()).
void takeMaps(const Case& found, Case& value) {
  std::vector<formats::Step>& steps = value.metadata.steps;
  for (const formats::Step& step : found.metadata.steps)
    if (step.name == "label-map" && std::find(steps.begin(), steps.end(), step) == steps.end())
      steps.push_back(step);
}

/// Gives proposals names that neither the vessels nor the seeds of a document have.
void rename(const Document& document, CenterlineTree& tree) {
  const std::set<std::string> others = takenLabels(document);
  std::set<std::string> taken = others;
  for (const formats::Branch& branch : tree.branches) taken.insert(branch.label);
  for (formats::Branch& branch : tree.branches)
    if (others.contains(branch.label)) {
      branch.label = convert::freeName(branch.label, taken);
      taken.insert(branch.label);
    }
}

/// Marks of the proposals that lie along vessels of a case.
std::vector<bool> knownBranches(const CenterlineTree& tree, const TubeTreeDistance& wall) {
  std::vector<bool> known;
  for (const formats::Branch& branch : tree.branches) {
    std::uint32_t inside = 0;
    for (std::uint32_t i = 0; i < branch.nodeCount; ++i) {
      const formats::Vec3f& c = tree.centre[branch.firstNode + i];
      inside += wall.nearest({c.x, c.y, c.z}).distance < 0;
    }
    known.push_back(2 * inside > branch.nodeCount);
  }
  return known;
}

}  // namespace

std::shared_ptr<const Case> proposalsBehind(Case found, std::uint32_t known) {
  std::vector<bool> goes(found.tree.branches.size(), false);
  std::fill_n(goes.begin(), known, true);
  found.models.reset();
  Joints joints(found.tree.nodeCount());
  joints.cutOff(found.tree, goes);
  joints.write(found);
  return without(std::move(found), goes);
}

std::shared_ptr<const Case> proposalsFor(const Document& document,
                                         std::shared_ptr<const Case> proposals) {
  if (!proposals) return nullptr;
  Case value = *proposals;
  std::vector<bool> known(value.tree.branches.size(), false);
  if (document.value) {
    const TubeTreeDistance wall(document.value->tree);
    known = knownBranches(value.tree, wall);
    Joints joints(value);
    for (const formats::Branch& branch : value.tree.branches) {
      const int parent = findParent(value.tree, branch);
      if (parent < 0 || !known[static_cast<std::size_t>(parent)]) continue;
      const formats::Vec3f& c = value.tree.centre[static_cast<std::size_t>(branch.parentNode)];
      const WallHit hit = wall.nearest({c.x, c.y, c.z});
      if (hit.distance < 0) joints.set(branch.firstNode, document.value->tree.centre[hit.node]);
    }
    joints.write(value);
  }
  rename(document, value.tree);
  return without(std::move(value), known);
}

std::vector<bool> chosenProposals(const Document& document, const Arguments& request) {
  if (!document.proposals) refuse("no vessel is proposed; find vessels first");
  const auto& branches = document.proposals->tree.branches;
  if (!request.has("labels")) return std::vector<bool>(branches.size(), true);
  std::vector<bool> chosen(branches.size(), false);
  for (const std::string& label : request.texts("labels")) {
    const auto found = std::find_if(branches.begin(), branches.end(),
                                    [&label](const auto& branch) { return branch.label == label; });
    if (found == branches.end())
      refuse("no proposal has the name \"" + formats::printable(label) + "\"");
    chosen[static_cast<std::size_t>(found - branches.begin())] = true;
  }
  return chosen;
}

Acceptance accepted(const Document& document, std::vector<bool> chosen) {
  const Case& found = *document.proposals;
  const CenterlineTree& tree = found.tree;
  for (std::size_t b = tree.branches.size(); b-- > 0;)
    if (const int parent = findParent(tree, tree.branches[b]); chosen[b] && parent >= 0)
      chosen[static_cast<std::size_t>(parent)] = true;
  std::vector<bool> others = chosen;
  others.flip();

  Acceptance out;
  out.count = static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), true));
  out.title = makeTitle("accept", found, chosen);
  out.document = document;
  if (document.value && document.value->tree.nodeCount() > 0) {
    out.firstNewNode = static_cast<std::uint32_t>(document.value->tree.nodeCount());
    out.value = std::make_shared<Case>(
        withBranches(*document.value, found, chosen, takenLabels(document), out.droppedArrays));
    takeMaps(found, *out.value);
  } else {
    out.value = std::make_shared<Case>(*without(found, others));
    Joints::remove(*out.value);
  }
  recordEdit(out.value->metadata, "accepted " + counted(out.count, "vessel", "vessels") + " that " +
                                      (out.count == 1 ? "was" : "were") + " found without seeds");
  Case rest = found;
  Joints joints(rest);
  joints.cutOff(tree, chosen);
  joints.write(rest);
  out.document.value = out.value;
  out.document.proposals = without(std::move(rest), chosen);
  return out;
}

Document rejected(const Document& document, const std::vector<bool>& chosen) {
  Document out = document;
  out.proposals = without(*document.proposals, chosen);
  return out;
}

std::string makeTitle(const char* verb, const Case& proposals, const std::vector<bool>& chosen) {
  const auto count = static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), true));
  const auto first = std::find(chosen.begin(), chosen.end(), true) - chosen.begin();
  return std::string(verb) + " " +
         (count == 1 ? proposals.tree.branches[static_cast<std::size_t>(first)].label
                     : counted(count, "vessel", "vessels"));
}

Json proposalsJson(const Document& document) {
  Json list = Json::array();
  if (!document.proposals) return list;
  const CenterlineTree& tree = document.proposals->tree;
  const Joints joints(*document.proposals);
  const std::vector<double> lengths = convert::vesselLengths(tree).branch;
  const std::vector<formats::VesselSystem> systems =
      formats::readBranchSystems(*document.proposals);
  for (const formats::Branch& branch : tree.branches) {
    const std::span radii = std::span(tree.radius).subspan(branch.firstNode, branch.nodeCount);
    const formats::Vec3f& middle = tree.centre[branch.firstNode + branch.nodeCount / 2];
    const int parent = findParent(tree, branch);
    const auto at = parent < 0 && document.value
                        ? joints.nodeAt(branch.firstNode, document.value->tree)
                        : std::nullopt;
    Json on = nullptr;
    if (parent >= 0) on = tree.branches[static_cast<std::size_t>(parent)].label;
    if (at) on = document.value->tree.branches[document.value->tree.branch[*at]].label;
    const auto confidence = branch.meanInlierRate;
    list.push_back(
        {{"label", branch.label},
         {"kind", formats::enumName(formats::kBranchKindNames, branch.kind)},
         {"system", formats::kVesselSystemNames[static_cast<std::size_t>(systems[list.size()])]},
         {"length_mm", engine::jsonNumber(lengths[list.size()])},
         {"radius_mm", engine::jsonNumber(static_cast<double>(radiusRange(radii).mean))},
         {"confidence", confidence ? engine::jsonNumber(*confidence) : Json(nullptr)},
         {"parent", std::move(on)},
         {"parent_waits", parent >= 0},
         {"position", {middle.x, middle.y, middle.z}}});
  }
  return list;
}

}  // namespace lumen::viewer
