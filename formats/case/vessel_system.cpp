// SPDX-License-Identifier: Apache-2.0
#include "formats/case/vessel_system.h"

#include <algorithm>

#include "formats/case/node_words.h"

namespace lumen::formats {

std::vector<VesselSystem> readNodeSystems(const Case& value) {
  return readNodeWords<VesselSystem>(value, kSystemArray);
}

std::vector<VesselSystem> readBranchSystems(const Case& value) {
  const std::vector<VesselSystem> nodes = readNodeSystems(value);
  std::vector<VesselSystem> branches;
  for (const Branch& branch : value.tree.branches) {
    std::array<std::size_t, kVesselSystemCount> count{};
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      ++count[static_cast<std::size_t>(nodes[n])];
    branches.push_back(
        static_cast<VesselSystem>(std::max_element(count.begin(), count.end()) - count.begin()));
  }
  return branches;
}

std::vector<VesselSystem> knownBranchSystems(const Case& value) {
  std::vector<VesselSystem> systems = readBranchSystems(value);
  if (std::all_of(systems.begin(), systems.end(),
                  [](VesselSystem system) { return system == VesselSystem::Unknown; }))
    systems.clear();
  return systems;
}

void setNodeSystems(Case& value, const std::vector<VesselSystem>& systems) {
  setNodeWords(value, kSystemExtension, kSystemArray, {systems.begin(), systems.end()});
}

}  // namespace lumen::formats
