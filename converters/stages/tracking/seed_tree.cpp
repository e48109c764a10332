// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/seed_tree.h"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace lumen::convert {

SeedTree::SeedTree(const std::vector<SeedBranch>& seeds) {
  std::unordered_map<std::string, int> position;
  for (const SeedBranch& seed : seeds) {
    const int above = seed.parent ? position.at(*seed.parent) : -1;
    position[seed.label] = static_cast<int>(parent.size());
    parent.push_back(above);
    depth.push_back(above < 0 ? 0 : depth[static_cast<std::size_t>(above)] + 1);
    deepest = std::max(deepest, depth.back());
  }
}

}  // namespace lumen::convert
