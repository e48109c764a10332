// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/work_list.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/judge/check/tree_places.h"
#include "formats/view/limits.h"

namespace lumen::viewer {

namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr std::array kKindNames = {"blocked",   "loose", "doubled",  "missing",
                                   "early-end", "dark",  "wall-off", "thin"};
constexpr double kThinVoxels = 0.5;     // of the mean radius
constexpr double kDarkRadii = 1.5;      // radii of a node in which the dark place in its lumen lies
constexpr double kIgnoredPlace = 0.01;  // mm: places are recorded with three decimals

/// The step by which a case records places that a person ignores: parameters are numbered texts, "KIND X Y Z
/// REASON".
constexpr const char* kIgnoreStep = "ignore";

const char* kindName(WorkKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::string lengthText(double mm) {
  return fixedText(mm, 1) + " mm";
}

/// Makes items of the places of one case.
class Lister {
public:
  Lister(const formats::Case& value, double voxel) : m_tree(value.tree), m_voxel(voxel) {}

  void add(WorkKind kind, const Vector3d& position, double reach, std::string about,
           std::optional<std::size_t> missing = {}) {
    m_items.push_back({kind, position, std::max(reach, m_voxel), std::move(about), missing});
  }
  void addAtNode(WorkKind kind, std::uint32_t node, std::string about,
                 std::optional<std::size_t> missing = {}) {
    add(kind, toEigen(m_tree.centre[node]), radius(node), std::move(about), missing);
  }
  [[nodiscard]] std::string label(std::uint32_t node) const {
    return m_tree.branches[m_tree.branch[node]].label;
  }
  [[nodiscard]] double radius(std::uint32_t node) const {
    return static_cast<double>(m_tree.radius[node]);
  }
  std::vector<WorkItem> take() {
    std::stable_sort(m_items.begin(), m_items.end(),
                     [](const WorkItem& a, const WorkItem& b) { return a.kind < b.kind; });
    return std::move(m_items);
  }

private:
  const CenterlineTree& m_tree;
  double m_voxel;
  std::vector<WorkItem> m_items;
};

/// A vessel that goes on beyond an end is a place of that end.
void addMissing(const convert::CheckReport& report, Lister& list) {
  for (const convert::OpenEnd& end : report.ends)
    if (end.vessel)
      list.addAtNode(WorkKind::EarlyEnd, end.node,
                     list.label(end.node) + (end.first ? " begins" : " ends") +
                         ", and the volume shows " + lengthText(end.goesOn) + " more of it",
                     end.vessel);
  const auto& vessels = report.missing.vessels;
  for (std::size_t i = 0; i < vessels.size(); ++i)
    if (!vessels[i].atEnd)
      list.add(WorkKind::Missing, vessels[i].path[vessels[i].path.size() / 2].position,
               vessels[i].radius,
               lengthText(vessels[i].length) + " of a vessel of radius " +
                   lengthText(vessels[i].radius) + " beside " +
                   list.label(vessels[i].path.front().node),
               i);
}

void addOfTree(const formats::Case& value, const convert::CheckReport& report,
               const convert::VolumeGeometry& geometry, Lister& list) {
  const CenterlineTree& tree = value.tree;
  for (const convert::LooseTree& loose : convert::findLooseTrees(tree, geometry))
    list.addAtNode(WorkKind::Loose, loose.node,
                   list.label(loose.node) + " hangs on nothing, with " +
                       counted(loose.branches, "vessel", "vessels") + " of " +
                       lengthText(loose.length));
  for (const convert::DoubledTrack& doubled : convert::findDoubledTracks(tree))
    list.addAtNode(WorkKind::Doubled, doubled.node,
                   list.label(doubled.node) + " runs in " + tree.branches[doubled.other].label +
                       " for " + lengthText(doubled.length));
  for (const convert::NodeStretch& poor : convert::findPoorStretches(tree, report.nodes)) {
    const std::uint32_t middle = (poor.first + poor.end) / 2;
    list.addAtNode(WorkKind::WallOff, middle,
                   "the wall of " + list.label(middle) + " is no edge of the volume for " +
                       lengthText(poor.length));
  }
  for (const formats::Branch& branch : tree.branches) {
    double sum = 0;
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      sum += list.radius(n);
    const double mean = sum / branch.nodeCount;
    if (branch.kind == formats::BranchKind::Vessel && mean < kThinVoxels * report.voxelSize)
      list.addAtNode(WorkKind::Thin, branch.firstNode + branch.nodeCount / 2,
                     branch.label + " has a mean radius of " + fixedText(mean, 2) +
                         " mm, less than half a voxel");
  }
}

// ---- what is left

std::uint32_t nearestNode(const CenterlineTree& tree, const Vector3d& point) {
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const double away = (toEigen(tree.centre[n]) - point).squaredNorm();
    if (away >= least) continue;
    least = away;
    best = n;
  }
  return best;
}

bool hasChild(const CenterlineTree& tree, std::uint32_t node) {
  return std::find(tree.parent.begin(), tree.parent.end(), static_cast<std::int32_t>(node)) !=
         tree.parent.end();
}

/// Whether the case is there as the item found it. `node` is the nearest.
bool isLeft(const WorkItem& item, const CenterlineTree& tree, std::uint32_t node) {
  const bool isNear = (toEigen(tree.centre[node]) - item.position).norm() <= item.reach;
  if (item.kind == WorkKind::Missing) return !isNear;
  if (!isNear) return false;
  if (item.kind == WorkKind::Loose) return tree.parent[node] < 0;
  if (item.kind == WorkKind::EarlyEnd) return tree.parent[node] < 0 || !hasChild(tree, node);
  return true;
}

struct IgnoredPlace {
  std::string kind, reason;
  Vector3d position = Vector3d::Zero();
  std::size_t step = 0;   ///< of the case
  std::string parameter;  ///< of the step
};

std::vector<IgnoredPlace> listIgnored(const formats::Metadata& metadata) {
  std::vector<IgnoredPlace> places;
  for (std::size_t s = 0; s < metadata.steps.size(); ++s) {
    if (metadata.steps[s].name != kIgnoreStep) continue;
    for (const auto& [name, value] : metadata.steps[s].parameters) {
      IgnoredPlace place;
      place.step = s;
      place.parameter = name;
      std::istringstream text(parameterText(value));
      if (text >> place.kind >> place.position[0] >> place.position[1] >> place.position[2] &&
          std::getline(text >> std::ws, place.reason))
        places.push_back(std::move(place));
    }
  }
  return places;
}

bool isIgnored(const WorkItem& item, const std::vector<IgnoredPlace>& ignored) {
  return std::any_of(ignored.begin(), ignored.end(), [&item](const IgnoredPlace& place) {
    return place.kind == kindName(item.kind) &&
           (place.position - item.position).norm() <= std::max(kIgnoredPlace, item.reach);
  });
}

}  // namespace

std::vector<WorkItem> listWork(const formats::Case& value, const convert::CheckReport& report,
                               const std::optional<convert::Reach>& reach,
                               const convert::VolumeGeometry& geometry) {
  Lister list(value, report.voxelSize);
  if (reach)
    for (const convert::ClosedPath& path : reach->closed)
      list.add(WorkKind::Blocked, {path.position.x, path.position.y, path.position.z},
               list.radius(path.node),
               path.branch + " is closed there: " + lengthText(path.beyond) +
                   " beyond cannot be reached");
  addMissing(report, list);
  for (const convert::Region& dark : report.dark.regions)
    list.add(WorkKind::Dark, dark.position, kDarkRadii * list.radius(dark.node),
             "the lumen of " + list.label(dark.node) + " is dark over " + shownNumber(dark.volume) +
                 " mm3");
  addOfTree(value, report, geometry, list);
  return list.take();
}

Json workJson(const std::vector<WorkItem>& items, std::size_t firstId, const formats::Case& value) {
  const std::vector<IgnoredPlace> ignored = listIgnored(value.metadata);
  Json left = Json::array(), set = Json::array();
  for (std::size_t i = 0; i < items.size(); ++i) {
    const WorkItem& item = items[i];
    const std::uint32_t node = nearestNode(value.tree, item.position);
    if (!isLeft(item, value.tree, node) || isIgnored(item, ignored)) continue;
    left.push_back({{"id", firstId + i},
                    {"kind", kindName(item.kind)},
                    {"position", engine::vectorJson(item.position)},
                    {"node", node},
                    {"branch", value.tree.branch[node]},
                    {"about", item.about},
                    {"missing", item.missing ? Json(*item.missing) : Json(nullptr)}});
  }
  for (const IgnoredPlace& place : ignored)
    set.push_back({{"kind", place.kind},
                   {"position", engine::vectorJson(place.position)},
                   {"reason", place.reason}});
  return {{"items", std::move(left)}, {"found", items.size()}, {"ignored", std::move(set)}};
}

Document withIgnored(const Document& document, const WorkItem& item, const std::string& reason) {
  if (reason.find_first_not_of(' ') == std::string::npos)
    refuse("a place is ignored for a reason: state one");
  auto value = std::make_shared<formats::Case>(*document.value);
  std::string text = kindName(item.kind);
  for (const double mm : item.position) text.append(" ").append(fixedText(mm, 3));
  recordNumbered(value->metadata, kIgnoreStep, text + " " + reason);
  Document ignoring = document;
  ignoring.value = std::move(value);
  return ignoring;
}

Document withoutIgnored(const Document& document, std::size_t number) {
  if (!document.value) refuse("there is no case");
  const std::vector<IgnoredPlace> ignored = listIgnored(document.value->metadata);
  if (number >= ignored.size()) refuse("no place with that number is ignored");
  auto value = std::make_shared<formats::Case>(*document.value);
  auto& steps = value->metadata.steps;
  const auto step = steps.begin() + static_cast<std::ptrdiff_t>(ignored[number].step);
  step->parameters.erase(ignored[number].parameter);
  if (step->parameters.empty()) steps.erase(step);
  Document changed = document;
  changed.value = std::move(value);
  return changed;
}

}  // namespace lumen::viewer
