// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/stated_vessels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/relayed_progress.h"
#include "converters/base/statistics.h"
#include "converters/geometry/automatic_names.h"
#include "converters/operations/labelled_vessels.h"
#include "converters/stages/tracking/branch_lumen.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/case/vessel_system.h"

namespace lumen::operations {
namespace {

using convert::BranchLumen;
using convert::TrackedBranch;
using convert::TrackedNode;
using convert::TrackedTree;
using Eigen::Vector3d;
using formats::VesselSystem;

/// Share of a map that vessels may fill: a label of more is of something else, as a threshold of
/// noise is, whose surface would take minutes.
constexpr double kMostVessels = 0.1;

/// Passes warnings on as details: a coarse map is no fault of the user's.
class UnwarnedProgress : public CountingProgress {
public:
  explicit UnwarnedProgress(Progress& shown) : CountingProgress(shown), m_shown(shown) {}
  void begin(std::string_view stage, std::size_t total) override {
    m_shown.check();
    CountingProgress::begin(stage, total);
  }
  void advance(std::size_t units) override {
    m_shown.check();
    CountingProgress::advance(units);
  }
  void warn(std::string_view message) override { m_shown.detail(message); }

private:
  Progress& m_shown;
};

/// The labels of a map that are of vessels, unless they fill too much of it.
std::set<std::int64_t> vesselsOf(const LabelPart& map) {
  std::set<std::int64_t> vessels;
  for (const convert::LabelMeaning& meaning : map.meanings)
    if (convert::isVessel(meaning.role) || meaning.role == convert::LabelRole::TrueLumen ||
        meaning.role == convert::LabelRole::FalseLumen)
      vessels.insert(meaning.value);
  std::size_t voxels = 0;
  for (const auto& [value, count] : convert::countLabels(map.voxels))
    if (vessels.contains(value)) voxels += count;
  const auto all = static_cast<double>(map.voxels.geometry.voxelCount());
  return static_cast<double>(voxels) > kMostVessels * all ? std::set<std::int64_t>() : vessels;
}

/// A tree with the system of each branch.
struct SystemTree {
  explicit SystemTree(const formats::Case& value)
      : tree(convert::makeTrackedTree(value)), systems(formats::readBranchSystems(value)) {}

  TrackedTree tree;
  std::vector<VesselSystem> systems;
};

/// A node of a tree, by its branch.
struct Place {
  int branch = -1, node = -1;
};

/// Adds the stretches of one stated tree to a tracked one.
class StatedStretches {
public:
  /// `rim`: mm by which the map may be off.
  StatedStretches(const convert::FoundVessels& found, double rim, SystemTree& tree)
      : m_found(found), m_rim(rim), m_tree(tree.tree), m_systems(tree.systems) {
    for (const TrackedBranch& branch : m_tree.branches) m_lumens.emplace_back(branch);
    for (const convert::SeedBranch& seed : m_tree.seeds) m_names.insert(seed.label);
  }

  void add(const SystemTree& stated) {
    for (std::size_t b = 0; b < stated.systems.size(); ++b) {
      if (!stated.tree.isVessel(b)) continue;
      m_system = stated.systems[b];
      const std::vector<TrackedNode>& nodes = stated.tree.branches[b].nodes;
      std::size_t first = 0;
      for (std::size_t i = 0; i <= nodes.size(); ++i) {
        if (i < nodes.size() && !isHeld(nodes[i].centre)) continue;
        addStretch(stated.tree, b, first, i);
        first = i + 1;
      }
    }
  }

private:
  [[nodiscard]] bool isHeld(const Vector3d& place) const {
    return convert::radiusAround(m_lumens, place, m_rim) > 0;
  }

  /// Whether a place is lumen by its level; a false lumen may have any but that of bone.
  [[nodiscard]] bool isLumen(const Vector3d& place) const {
    return m_found.isLumen(place) ||
           (m_system == VesselSystem::FalseLumen && !m_found.isBone(place) &&
            m_found.geometry.containsWorld(place));
  }

  /// The nodes [first, end) of a branch, without those at both ends that are no lumen by level.
  void addStretch(const TrackedTree& stated, std::size_t b, std::size_t first, std::size_t end) {
    const std::vector<TrackedNode>& nodes = stated.branches[b].nodes;
    std::optional<Vector3d> before, behind;  // the lumen that the stretch begins and ends in
    if (first > 0) before = nodes[first - 1].centre;
    if (end < nodes.size()) behind = nodes[end].centre;
    if (first == 0 && stated.branches[b].parentBranch >= 0) {
      const auto& above =
          stated.branches[static_cast<std::size_t>(stated.branches[b].parentBranch)];
      before = above.nodes[static_cast<std::size_t>(stated.branches[b].parentNode)].centre;
    }
    for (; first < end && !isLumen(nodes[first].centre); ++first) before.reset();
    for (; first < end && !isLumen(nodes[end - 1].centre); --end) behind.reset();
    if (!isVessel(std::span(nodes).subspan(first, end - first))) return;
    TrackedBranch branch;
    branch.nodes.assign(nodes.begin() + static_cast<std::ptrdiff_t>(first),
                        nodes.begin() + static_cast<std::ptrdiff_t>(end));
    for (TrackedNode& node : branch.nodes) node.origin = formats::NodeOrigin::Given;
    branch.stopReason = formats::StopReason::NoValidCylinder;
    Place parent = before ? nearest(*before) : Place{};
    if (parent.branch < 0 && behind) {
      parent = nearest(*behind);
      convert::reverseTrack(branch.nodes);
    }
    branch.parentBranch = parent.branch;
    branch.parentNode = parent.node;
    append(std::move(branch));
  }

  [[nodiscard]] bool isVessel(std::span<const TrackedNode> nodes) const {
    if (nodes.empty()) return false;
    std::vector<double> radii;
    std::size_t lumen = 0;
    for (const TrackedNode& node : nodes) {
      radii.push_back(node.radius);
      lumen += isLumen(node.centre) ? 1 : 0;
    }
    const double beside =
        std::max(convert::radiusAround(m_lumens, nodes.front().centre, 2 * m_rim + radii.front()),
                 convert::radiusAround(m_lumens, nodes.back().centre, 2 * m_rim + radii.back()));
    return 2 * lumen > nodes.size() &&
           convert::measureLength(nodes) > 2 * std::max(upperMedian(radii), beside);
  }

  /// The node nearest to a place on the vessels so far, whose lumen holds it, but for those of a
  /// system that is apart.
  [[nodiscard]] Place nearest(const Vector3d& place) const {
    Place out;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < m_tree.branches.size(); ++i) {
      const TrackedBranch& branch = m_tree.branches[i];
      if (branch.nodes.empty() || !m_tree.isVessel(i)) continue;
      if (formats::areApart(m_system, m_systems[i])) continue;
      const convert::ChainPoint at = convert::closestOnChain(branch.nodes, place);
      if (at.distance >= std::min(least, at.radius + 2 * m_rim)) continue;
      least = at.distance;
      out = {static_cast<int>(i), static_cast<int>(at.node)};
    }
    return out;
  }

  void append(TrackedBranch branch) {
    convert::SeedBranch seed;
    std::size_t number = m_tree.seeds.size();
    do seed.label = convert::provisionalName(++number);
    while (!m_names.insert(seed.label).second);
    seed.points.push_back({branch.nodes.front().centre, std::nullopt});
    m_tree.seeds.push_back(std::move(seed));
    m_tree.branches.push_back(std::move(branch));
    m_systems.push_back(m_system);
  }

  const convert::FoundVessels& m_found;
  double m_rim;
  TrackedTree& m_tree;
  std::vector<VesselSystem>& m_systems;           ///< of its branches
  VesselSystem m_system = VesselSystem::Unknown;  ///< of the stretch at hand
  std::vector<BranchLumen> m_lumens;              ///< of the found vessels
  std::set<std::string> m_names;
};

}  // namespace

std::vector<formats::Case> statedVessels(const std::vector<LabelPart>& maps,
                                         const Context& context) {
  std::vector<formats::Case> cases;
  UnwarnedProgress quiet(context.progress);
  for (const LabelPart& map : maps) {
    const std::set<std::int64_t> vessels = vesselsOf(map);
    if (vessels.empty()) continue;
    try {
      cases.push_back(labelledVessels(map, vessels, context.within(quiet)));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      context.progress.detail(error.what());  // a map of specks, or of other voxels: it has no tree
    }
  }
  return cases;
}

std::size_t addStatedVessels(const std::vector<formats::Case>& stated,
                             const convert::FoundVessels& found, formats::Case& target) {
  const std::size_t before = target.tree.branches.size();
  for (const formats::Case& one : stated) {
    const auto firstNew = static_cast<std::uint32_t>(target.tree.nodeCount());
    SystemTree tree(target);
    StatedStretches(found, one.metadata.voxelSize.value_or(0), tree).add(SystemTree(one));
    convert::appendTracks(tree.tree, target);
    std::vector<VesselSystem> systems = formats::readNodeSystems(target);
    for (std::uint32_t n = firstNew; n < systems.size(); ++n)
      systems[n] = tree.systems[target.tree.branch[n]];
    formats::setNodeSystems(target, systems);
  }
  return target.tree.branches.size() - before;
}

}  // namespace lumen::operations
