// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/branch_systems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

using formats::VesselSystem;

namespace {

void setBranchSystems(formats::Case& value, const std::vector<VesselSystem>& branches) {
  std::vector<VesselSystem> nodes;
  for (const std::uint32_t branch : value.tree.branch) nodes.push_back(branches[branch]);
  formats::setNodeSystems(value, nodes);
}

/// The median radius of each branch, mm.
std::vector<double> medianRadii(const formats::CenterlineTree& tree) {
  std::vector<double> radii;
  for (const formats::Branch& branch : tree.branches) {
    const auto first = tree.radius.begin() + branch.firstNode;
    radii.push_back(median({first, first + branch.nodeCount}));
  }
  return radii;
}

/// The most that a vessel is wider than one of two equal ones that it divides into (C. D. Murray,
/// "The physiological principle of minimum work", 1926).
const double kMurray = std::cbrt(2);

}  // namespace

void takeSystems(const LabelMask& mask, std::span<const LabelRole> roles, formats::Case& value) {
  std::vector<VesselSystem> systems = formats::readBranchSystems(value);
  const formats::CenterlineTree& tree = value.tree;
  for (std::size_t b = 0; b < systems.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    std::array<double, formats::kVesselSystemCount> length{};
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      if (const std::uint8_t label = labelAt(mask, toEigen(tree.centre[n])); label != 0)
        length[static_cast<std::size_t>(systemOf(roles[label - 1U]))] += double{tree.radius[n]};
    const auto most = std::max_element(length.begin() + 1, length.end());
    if (*most > 0) systems[b] = static_cast<VesselSystem>(most - length.begin());
  }
  setBranchSystems(value, systems);
}

void spreadSystems(formats::Case& value) {
  std::vector<VesselSystem> systems = formats::readBranchSystems(value);
  const formats::CenterlineTree& tree = value.tree;
  const auto parentOf = [&](std::size_t b) {
    const std::int32_t node = tree.branches[b].parentNode;
    return node < 0 ? b : std::size_t{tree.branch[static_cast<std::size_t>(node)]};
  };
  const std::vector<double> radii = medianRadii(tree);
  const auto take = [&](std::size_t to, std::size_t from) {
    if (systems[to] != VesselSystem::Unknown || radii[to] > kMurray * radii[from]) return;
    const bool isTrue = systems[from] == VesselSystem::TrueLumen;
    systems[to] = isTrue ? VesselSystem::Artery : systems[from];
  };
  for (std::size_t b = 0; b < systems.size(); ++b) take(b, parentOf(b));
  for (std::size_t b = systems.size(); b-- > 0;) take(parentOf(b), b);
  for (std::size_t b = 0; b < systems.size(); ++b) take(b, parentOf(b));
  setBranchSystems(value, systems);
}

void appendTrees(const formats::Case& from, formats::Case& target) {
  std::vector<formats::NodeOrigin> origins = formats::readNodeOrigins(target);
  for (const formats::NodeOrigin origin : formats::readNodeOrigins(from)) origins.push_back(origin);
  std::vector<VesselSystem> systems = formats::readNodeSystems(target);
  for (const VesselSystem system : formats::readNodeSystems(from)) systems.push_back(system);
  formats::CenterlineTree& tree = target.tree;
  std::set<std::string> taken;
  for (const formats::Branch& branch : tree.branches) taken.insert(branch.label);
  const auto nodes = static_cast<std::uint32_t>(tree.nodeCount());
  const auto branches = static_cast<std::uint32_t>(tree.branches.size());
  const auto moved = [&](std::int32_t node) {
    return node < 0 ? node : node + static_cast<std::int32_t>(nodes);
  };
  const auto append = [](const auto& more, auto& all) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(from.tree.centre, tree.centre);
  append(from.tree.direction, tree.direction);
  append(from.tree.radius, tree.radius);
  append(from.tree.height, tree.height);
  append(from.tree.inlierRate, tree.inlierRate);
  for (const std::int32_t parent : from.tree.parent) tree.parent.push_back(moved(parent));
  for (const std::uint32_t branch : from.tree.branch) tree.branch.push_back(branches + branch);
  for (const auto& [a, b] : from.tree.links) tree.links.push_back({nodes + a, nodes + b});
  for (formats::Branch branch : from.tree.branches) {
    taken.insert(branch.label = freeName(branch.label, taken));
    branch.firstNode += nodes;
    branch.parentNode = moved(branch.parentNode);
    tree.branches.push_back(std::move(branch));
  }
  const auto points = static_cast<std::uint32_t>(target.points->position.size());
  for (std::size_t i = 1; i < from.points->offset.size(); ++i)
    target.points->offset.push_back(points + from.points->offset[i]);
  append(from.points->position, target.points->position);
  append(from.metadata.steps, target.metadata.steps);
  formats::setNodeOrigins(target, origins);
  formats::setNodeSystems(target, systems);
}

}  // namespace lumen::convert
