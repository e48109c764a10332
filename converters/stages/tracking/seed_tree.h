// SPDX-License-Identifier: Apache-2.0
// How the seeds say that vessels hang together.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// For every seed, its parent's position in the list (-1: none) and its depth below a root.
struct SeedTree {
  explicit SeedTree(const std::vector<SeedBranch>& seeds);

  std::vector<int> parent, depth;
  int deepest = 0;
};

}  // namespace lumen::convert
